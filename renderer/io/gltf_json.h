// Reading of untrusted nlohmann::json and the document as it is prepared for tinygltf. Internal to
// renderer/io.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf_files.h"

namespace midway::gltf {

using Json = nlohmann::json;

// The JSON of a file with the contents of its buffers: what decompression reads and rewrites.
struct RawDocument {
    std::string path;
    Json root;
    std::vector<Bytes> buffers;
    std::vector<std::string> warnings;
};

// Null where `object` is no object or lacks the key.
const Json* find(const Json& object, const char* key);
Json* find(Json& object, const char* key);

// A member that is a non-negative integer; `otherwise` where absent; throws for anything else.
std::uint64_t natural(const RawDocument& document, const Json& object, const char* key,
                      std::optional<std::uint64_t> otherwise = std::nullopt);

// A string member, empty where absent or no string.
std::string text(const Json& object, const char* key);

// The array named `key` at the root; empty where absent.
Json::array_t* array(RawDocument& document, const char* key);

// Bytes [offset, offset + length) of a buffer; throws where they do not exist.
ByteSpan buffer_range(const RawDocument& document, std::uint64_t buffer, std::uint64_t offset,
                      std::uint64_t length);

// Appends a buffer with one view over all of it; returns the view's index.
int append_view(RawDocument& document, Bytes bytes, std::uint64_t stride);

}  // namespace midway::gltf
