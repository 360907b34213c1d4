// The JSON library comes before tinygltf, which would otherwise include it with hidden symbols.
#include "io/gltf_json.h"

#define TINYGLTF_IMPLEMENTATION
#include <algorithm>
#include <fstream>

#include "io/gltf.h"
#include "io/gltf_compression.h"
#include "io/gltf_document.h"

namespace midway::gltf {
namespace {

constexpr std::size_t max_warnings = 200;

bool supported(const std::string& name) {
    return std::find(supported_gltf_extensions.begin(), supported_gltf_extensions.end(), name) !=
           supported_gltf_extensions.end();
}

Json parse_json(std::string_view json, const std::string& path) {
    check_json_depth(json, path);
    Json root;
    try {
        root = Json::parse(json);
    } catch (const Json::exception& error) {
        fail(path, "not valid JSON: " + printable(error.what()));
    }
    if (!root.is_object()) fail(path, "the JSON is not an object", "name a .gltf or .glb file");
    return root;
}

void check_version(const RawDocument& document) {
    const Json* asset = find(document.root, "asset");
    const std::string version = asset ? text(*asset, "version") : "";
    const std::string minimum = asset ? text(*asset, "minVersion") : "";
    if (version.empty()) fail(document.path, "no asset.version", "name a glTF 2.0 file");
    const std::string& needed = minimum.empty() ? version : minimum;
    if (needed.substr(0, 2) != "2." || (!minimum.empty() && minimum != "2.0")) {
        fail(document.path, "glTF version " + printable(needed), "convert it to glTF 2.0");
    }
}

void check_extensions(RawDocument& document) {
    for (const char* key : {"extensionsRequired", "extensionsUsed"}) {
        const Json::array_t* names = array(document, key);
        if (!names) continue;
        for (const Json& entry : *names) {
            const std::string name = entry.is_string() ? entry.get<std::string>() : "";
            if (supported(name)) continue;
            if (std::string_view(key) == "extensionsRequired") {
                fail(document.path, "requires the extension \"" + printable(name) + "\"",
                     "export without it");
            }
            document.warnings.push_back("extension " + printable(name) +
                                        " is not supported; what it describes is left out");
        }
    }
}

bool is_fallback(const Json& buffer) {
    const Json* extensions = find(buffer, "extensions");
    const Json* meshopt = extensions ? find(*extensions, "EXT_meshopt_compression") : nullptr;
    const Json* fallback = meshopt ? find(*meshopt, "fallback") : nullptr;
    return fallback && fallback->is_boolean() && fallback->get<bool>();
}

void load_buffers(RawDocument& document, ByteSpan binary) {
    const Json::array_t* buffers = array(document, "buffers");
    if (!buffers) return;
    std::uint64_t left = 2 * max_file_bytes;
    for (std::size_t i = 0; i < buffers->size(); ++i) {
        const Json& buffer = (*buffers)[i];
        const std::string name = "buffer " + std::to_string(i);
        const std::uint64_t length = natural(document, buffer, "byteLength");
        const std::string uri = text(buffer, "uri");
        Bytes bytes;
        if (is_fallback(buffer)) {
            // Only views that meshopt decoding replaces may point here.
        } else if (!uri.empty()) {
            bytes = read_uri(document.path, uri);
        } else if (i == 0 && binary.data()) {
            bytes.assign(binary.begin(),
                         binary.begin() + std::min<std::uint64_t>(length, binary.size()));
        } else {
            fail(document.path, name + " has no data");
        }
        if (!is_fallback(buffer) && bytes.size() < length) {
            fail(document.path, name + " holds " + std::to_string(bytes.size()) + " of " +
                                    std::to_string(length) + " bytes");
        }
        if (bytes.size() > left)
            fail(document.path, "more than 8 GiB of buffers", "split the scene");
        left -= bytes.size();
        document.buffers.push_back(std::move(bytes));
    }
}

// tinygltf ignores what has the wrong sign or type: that would silently read other bytes.
void check_numbers(RawDocument& document) {
    for (const char* kind : {"bufferViews", "accessors"}) {
        const Json::array_t* entries = array(document, kind);
        if (!entries) continue;
        for (const Json& entry : *entries) {
            natural(document, entry, "byteOffset", 0);
            natural(document, entry, "byteStride", 0);
            natural(document, entry, "bufferView", 0);
        }
    }
}

std::vector<ImageSource> take_images(RawDocument& document) {
    std::vector<ImageSource> images;
    if (Json::array_t* entries = array(document, "images")) {
        for (const Json& entry : *entries) {
            const Json* view = find(entry, "bufferView");
            const bool usable = view && view->is_number_unsigned() && *view < 0x7fffffff;
            images.push_back(
                {text(entry, "name"), text(entry, "uri"), usable ? view->get<int>() : -1});
        }
    }
    document.root.erase("images");
    return images;
}

// Makes a text that tinygltf reads as it is meant. It casts wide integers to int (2^32 becomes 0),
// so those become doubles, which it refuses as indices and keeps as values; sizes it reads in 64
// bits.
void tame(Json& value) {
    if (value.is_object()) {
        value.erase("extras");
        for (auto& [key, entry] : value.items()) {
            const bool wide = key == "byteOffset" || key == "byteLength" || key == "count";
            if (!wide || entry.is_structured()) tame(entry);
        }
    } else if (value.is_array()) {
        for (Json& entry : value) tame(entry);
    } else if (value.is_number_integer()) {
        const double number = value.get<double>();
        if (number > 2147483647.0 || number < -2147483648.0) value = number;
    }
}

std::vector<std::size_t> primitive_counts(RawDocument& document) {
    std::vector<std::size_t> counts;
    if (const Json::array_t* meshes = array(document, "meshes")) {
        for (const Json& mesh : *meshes) {
            const Json* primitives = find(mesh, "primitives");
            counts.push_back(primitives && primitives->is_array() ? primitives->size() : 0);
        }
    }
    return counts;
}

void parse_model(Document& document, RawDocument& raw) {
    for (const char* key : {"buffers", "animations"}) raw.root.erase(key);
    const std::vector<std::size_t> counts = primitive_counts(raw);
    tame(raw.root);
    std::string json = raw.root.dump(-1, ' ', false, Json::error_handler_t::replace);
    raw.root = nullptr;
    if (json.size() > max_json_bytes * 2) fail(document.path, "too much JSON", "use GLB");
    tinygltf::TinyGLTF parser;
    std::string error, notes;
    if (!parser.LoadASCIIFromString(&document.model, &error, &notes, json.data(),
                                    static_cast<unsigned>(json.size()), "")) {
        fail(document.path, "not valid glTF: " + (error.empty() ? "a required property is missing"
                                                                : printable(error)));
    }
    for (std::size_t i = 0; i < counts.size() && i < document.model.meshes.size(); ++i) {
        if (document.model.meshes[i].primitives.size() < counts[i]) {
            warn(document,
                 "mesh " + std::to_string(i) + " has primitives without attributes; left out");
        }
    }
    document.model.buffers.resize(raw.buffers.size());
    for (std::size_t i = 0; i < raw.buffers.size(); ++i) {
        document.model.buffers[i].data = std::move(raw.buffers[i]);
    }
}

}  // namespace

Document parse_document(ByteSpan file, const std::string& path) {
    const Container container = split_container(file, path);
    RawDocument raw{path, parse_json(container.json, path), {}, {}};
    check_version(raw);
    check_extensions(raw);
    load_buffers(raw, container.binary);
    check_numbers(raw);
    decode_meshopt(raw);
    decode_draco(raw);
    Document document;
    document.path = path;
    document.images = take_images(raw);
    for (const std::string& line : raw.warnings) warn(document, line);
    parse_model(document, raw);
    return document;
}

void warn(Document& document, const std::string& line) {
    std::vector<std::string>& lines = document.warnings;
    if (lines.size() > max_warnings) return;
    if (std::find(lines.begin(), lines.end(), line) != lines.end()) return;
    lines.push_back(lines.size() < max_warnings ? line : "more warnings are not listed");
}

ByteSpan view_bytes(const Document& document, int view) {
    const tinygltf::BufferView& entry =
        at(document, document.model.bufferViews, view, "buffer view");
    const tinygltf::Buffer& buffer = at(document, document.model.buffers, entry.buffer, "buffer");
    if (entry.byteOffset > buffer.data.size() ||
        entry.byteLength > buffer.data.size() - entry.byteOffset) {
        fail(document.path,
             "buffer view " + std::to_string(view) + " reaches past the end of its buffer");
    }
    return ByteSpan(buffer.data).subspan(entry.byteOffset, entry.byteLength);
}

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto it = extensions.find(name);
    return it != extensions.end() && it->second.IsObject() ? &it->second : nullptr;
}

const tinygltf::Value* member(const tinygltf::Value& object, const char* key) {
    return object.Has(key) ? &object.Get(key) : nullptr;
}

double number(const tinygltf::Value& object, const char* key, double otherwise) {
    const tinygltf::Value* value = member(object, key);
    return value && value->IsNumber() ? value->GetNumberAsDouble() : otherwise;
}

int integer(const tinygltf::Value& object, const char* key, int otherwise) {
    const tinygltf::Value* value = member(object, key);
    return value && value->IsInt() ? value->Get<int>() : otherwise;
}

}  // namespace midway::gltf
