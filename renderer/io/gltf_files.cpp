#include "io/gltf_files.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace midway::gltf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_printable = 100;
constexpr std::uint32_t glb_magic = 0x46546C67, glb_json = 0x4E4F534A, glb_binary = 0x004E4942;

std::uint32_t read_u32(ByteSpan bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::array<std::int8_t, 256> base64_table() {
    std::array<std::int8_t, 256> table{};
    table.fill(-1);
    const std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < digits.size(); ++i) {
        table[static_cast<std::uint8_t>(digits[i])] = static_cast<std::int8_t>(i);
    }
    return table;
}

Bytes decode_base64(std::string_view text, const std::string& path) {
    static const std::array<std::int8_t, 256> table = base64_table();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    Bytes out;
    out.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int value = table[static_cast<std::uint8_t>(c)];
        if (value < 0) fail(path, "a data URI holds a character that is not base64");
        bits = (bits << 6) | static_cast<std::uint32_t>(value);
        count += 6;
        if (count >= 8) {
            count -= 8;
            out.push_back(static_cast<std::uint8_t>(bits >> count));
        }
    }
    return out;
}

Bytes read_data_uri(const std::string& uri, const std::string& path) {
    const std::size_t comma = uri.find(',');
    constexpr std::string_view marker = ";base64";
    if (comma == std::string::npos || comma < marker.size() ||
        uri.compare(comma - marker.size(), marker.size(), marker) != 0) {
        fail(path, "a data URI is not base64: \"" + printable(uri) + "\"");
    }
    return decode_base64(std::string_view(uri).substr(comma + 1), path);
}

// The file that a relative URI names, proven to lie inside the scene's folder after links are
// followed.
std::string resolve_inside(const std::string& scene_path, const std::string& uri) {
    const std::string name = percent_decode(uri);
    const std::string shown = "\"" + printable(uri) + "\"";
    const auto refuse = [&](const char* why) {
        fail(scene_path, "the file " + shown + " " + why, "keep all files in the scene's folder");
    };
    const bool odd = std::any_of(name.begin(), name.end(), [](char c) {
        return c == ':' || c == '\\' || static_cast<unsigned char>(c) < 32;
    });
    if (name.empty() || odd || name.front() == '/') refuse("is not named by a relative path");
    for (const fs::path& part : fs::path(name)) {
        if (part == "..") refuse("lies outside the scene's folder");
    }
    std::error_code error;
    fs::path folder = fs::path(scene_path).parent_path();
    if (folder.empty()) folder = ".";
    folder = fs::canonical(folder, error);
    if (error) refuse("cannot be found");
    const fs::path file = fs::canonical(folder / name, error);
    if (error) refuse("cannot be found");
    const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    if (end != folder.end() || rest == file.end()) refuse("lies outside the scene's folder");
    return file.string();
}

}  // namespace

std::string percent_decode(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '%' && i + 2 < text.size();
        const int high = escape ? hex_digit(text[i + 1]) : -1;
        const int low = escape ? hex_digit(text[i + 2]) : -1;
        if (high >= 0 && low >= 0) {
            out.push_back(static_cast<char>(high * 16 + low));
            i += 2;
        } else {
            out.push_back(text[i]);
        }
    }
    return out;
}

bool is_data_uri(const std::string& uri) {
    constexpr std::string_view scheme = "data:";
    return uri.size() >= scheme.size() &&
           std::equal(scheme.begin(), scheme.end(), uri.begin(),
                      [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b + 32 : b); });
}

std::string printable(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, max_printable)) {
        const auto byte = static_cast<unsigned char>(c);
        out.push_back(byte < 32 || byte == 127 ? ' ' : c);
    }
    if (text.size() > max_printable) out += "...";
    return out;
}

void fail(const std::string& path, const std::string& what, const std::string& remedy) {
    throw std::runtime_error(what + " (" + path + "); " + remedy);
}

Bytes read_file(const std::string& path) {
    std::error_code error;
    if (!fs::exists(path, error)) fail(path, "file not found", "check the path");
    if (!fs::is_regular_file(path, error)) fail(path, "not a regular file", "name a file");
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) fail(path, "cannot be read", "check its permissions");
    if (size > max_file_bytes) fail(path, "larger than 4 GiB", "split the scene");
    std::ifstream stream(path, std::ios::binary);
    Bytes bytes(size);
    if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
        fail(path, "cannot be read", "check its permissions");
    }
    return bytes;
}

Bytes read_uri(const std::string& scene_path, const std::string& uri) {
    if (is_data_uri(uri)) return read_data_uri(uri, scene_path);
    return read_file(resolve_inside(scene_path, uri));
}

Container split_container(ByteSpan file, const std::string& path) {
    constexpr std::size_t header = 12, chunk_header = 8;
    Container out;
    if (file.size() < 4 || read_u32(file, 0) != glb_magic) {
        out.json = {reinterpret_cast<const char*>(file.data()), file.size()};
    } else {
        if (file.size() < header) fail(path, "truncated GLB header");
        const std::uint32_t version = read_u32(file, 4), length = read_u32(file, 8);
        if (version != 2) {
            fail(path, "GLB version " + std::to_string(version), "convert it to glTF 2.0");
        }
        if (length > file.size() || length < header) {
            fail(path, "truncated GLB: " + std::to_string(file.size()) + " of " +
                           std::to_string(length) + " bytes");
        }
        file = file.first(length);
        std::size_t offset = header;
        for (int chunk = 0; file.size() - offset >= chunk_header; ++chunk) {
            const std::uint32_t size = read_u32(file, offset), type = read_u32(file, offset + 4);
            offset += chunk_header;
            if (size > file.size() - offset) fail(path, "truncated GLB chunk");
            const ByteSpan data = file.subspan(offset, size);
            offset += size;
            if (chunk == 0 && type != glb_json) fail(path, "the first GLB chunk is not JSON");
            if (chunk == 0) out.json = {reinterpret_cast<const char*>(data.data()), data.size()};
            if (chunk == 1 && type == glb_binary) out.binary = data;
        }
    }
    // Some exporters pad the JSON chunk with zero bytes instead of spaces.
    while (!out.json.empty() && out.json.back() == '\0') out.json.remove_suffix(1);
    if (out.json.empty()) fail(path, "no JSON in the file", "name a .gltf or .glb file");
    if (out.json.size() > max_json_bytes) fail(path, "more than 512 MiB of JSON", "use GLB");
    return out;
}

void check_json_depth(std::string_view json, const std::string& path) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > max_json_depth) {
                fail(path, "JSON nests deeper than " + std::to_string(max_json_depth));
            }
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

}  // namespace midway::gltf
