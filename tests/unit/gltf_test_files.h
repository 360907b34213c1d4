// Small glTF files written by tests: a JSON object and one binary buffer that grow part by part.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/gltf.h"
#include "support/temp_dir.h"

namespace midway::test {

using Json = nlohmann::json;

inline constexpr int type_byte = 5120, type_ubyte = 5121, type_short = 5122, type_ushort = 5123,
                     type_uint = 5125, type_float = 5126;

// A red and a blue texel (0, 128, 255), 2 x 1.
inline const std::string tiny_png =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAA"
    "D0lEQVR42mP4z8DA0PAfAAgAAn8lPvwJAAAAAElFTkSuQmCC";

inline void write_file(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

inline std::vector<std::uint8_t> tiny_png_bytes() {
    return {137, 80,  78, 71, 13,  10,  26,  10, 0,   0,   0,   13,  73,  72,  68,  82, 0,  0,
            0,   2,   0,  0,  0,   1,   8,   2,  0,   0,   0,   123, 64,  232, 221, 0,  0,  0,
            15,  73,  68, 65, 84,  120, 218, 99, 248, 207, 192, 192, 208, 240, 31,  0,  8,  0,
            2,   127, 37, 62, 252, 9,   0,   0,  0,   0,   73,  69,  78,  68,  174, 66, 96, 130};
}

struct GltfFile {
    TempDir folder;
    Json root = {{"asset", {{"version", "2.0"}}}};
    std::string binary;

    // Adds raw bytes as a buffer view; returns its index.
    template <typename T>
    int view(const std::vector<T>& values) {
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        const std::size_t offset = binary.size(), length = values.size() * sizeof(T);
        binary.resize(offset + length);
        if (length > 0) std::memcpy(binary.data() + offset, values.data(), length);
        root["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}});
        return static_cast<int>(root["bufferViews"].size()) - 1;
    }
    template <typename T>
    int accessor(const std::vector<T>& values, const std::string& kind, int type, std::size_t count,
                 bool normalized = false) {
        Json entry = {{"bufferView", view(values)},
                      {"componentType", type},
                      {"count", count},
                      {"type", kind}};
        if (normalized) entry["normalized"] = true;
        return add("accessors", entry);
    }
    int floats(const std::vector<float>& values, const std::string& kind) {
        const std::size_t width = kind == "SCALAR" ? 1 : kind == "MAT4" ? 16 : kind[3] - '0';
        return accessor(values, kind, type_float, values.size() / width);
    }
    int add(const std::string& kind, const Json& entry) {
        root[kind].push_back(entry);
        return static_cast<int>(root[kind].size()) - 1;
    }
    // A mesh of one primitive, shown by a node of its own. Returns the node.
    int show(const Json& primitive) {
        const int mesh = add("meshes", {{"primitives", Json::array({primitive})}});
        return add("nodes", {{"mesh", mesh}});
    }
    // The unit square in the xy plane as four vertices (0,0) (1,0) (0,1) (1,1).
    int square() { return floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3"); }
    int square_indices() {
        return accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR", type_ushort, 6);
    }
    Json square_primitive() {
        return {{"attributes", {{"POSITION", square()}}}, {"indices", square_indices()}};
    }
    std::string path() const { return (folder / "scene.gltf").string(); }
    std::string write() {
        if (!binary.empty() && !root.contains("buffers")) {
            root["buffers"] = {{{"uri", "scene.bin"}, {"byteLength", binary.size()}}};
            write_file(folder / "scene.bin", binary);
        }
        write_file(path(), root.dump());
        return path();
    }
    SceneDescription load() { return load_gltf(write()); }
    // The message of the error that loading throws; empty where it loads.
    std::string error() {
        try {
            load();
        } catch (const std::runtime_error& failure) {
            return failure.what();
        }
        return "";
    }
};

inline bool mentions(const std::vector<std::string>& lines, const std::string& text) {
    for (const std::string& line : lines) {
        if (line.find(text) != std::string::npos) return true;
    }
    return false;
}

}  // namespace midway::test
