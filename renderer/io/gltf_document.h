// A glTF file after parsing: tinygltf's Model with all buffers in memory, compression undone,
// images still encoded. tinygltf parses but does not validate, opens any path and recurses without
// limit, so it is given a text that names no file and holds no image; whoever reads an index of the
// Model checks it (gltf_accessor.h does for the data). Internal to renderer/io.
#pragma once

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

#include <cstdint>
#include <string>
#include <vector>

#include "io/gltf_files.h"

namespace midway::gltf {

// Where an image's encoded bytes are: a URI, or a buffer view where view >= 0.
struct ImageSource {
    std::string name;
    std::string uri;
    int view = -1;
};

// Elements of accessors that one file may make us read, all uses counted: a small file can use one
// large accessor any number of times.
inline constexpr std::uint64_t max_elements = 1ull << 29;

struct Document {
    std::string path;
    tinygltf::Model model;
    std::vector<ImageSource> images;
    std::vector<std::string> warnings;
    std::uint64_t elements_left = max_elements;
};

Document parse_document(ByteSpan file, const std::string& path);

// Adds a line to the warnings unless it is there already; after 200 lines only says so.
void warn(Document& document, const std::string& line);

// The bytes of a buffer view; throws when the view or its range does not exist.
ByteSpan view_bytes(const Document& document, int view);

// Element `index` of one of the Model's arrays; throws "KIND 7 does not exist" beyond its end.
template <typename T>
const T& at(const Document& document, const std::vector<T>& array, int index, const char* kind) {
    if (index < 0 || static_cast<std::size_t>(index) >= array.size()) {
        fail(document.path, std::string(kind) + " " + std::to_string(index) + " does not exist");
    }
    return array[static_cast<std::size_t>(index)];
}

// Members of an extension object; the default where absent or of another type.
const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name);
const tinygltf::Value* member(const tinygltf::Value& object, const char* key);
double number(const tinygltf::Value& object, const char* key, double otherwise);
int integer(const tinygltf::Value& object, const char* key, int otherwise);

}  // namespace midway::gltf
