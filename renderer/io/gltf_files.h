// Bytes of a glTF scene: files, data URIs and the GLB container. Nothing outside the scene's own
// folder is opened. Throws std::runtime_error "WHAT (FILE); REMEDY".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace midway::gltf {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

inline constexpr std::uint64_t max_file_bytes = 1ull << 32;  // what GLB can address
inline constexpr std::uint64_t max_json_bytes = 1ull << 29;
inline constexpr int max_json_depth = 128;

// Printable form of a text that a stranger wrote: one line, no control characters, at most 100
// long.
std::string printable(std::string_view text);

// Throws std::runtime_error "what (path); remedy".
[[noreturn]] void fail(const std::string& path, const std::string& what,
                       const std::string& remedy = "export it again or ask the glTF validator");

// A regular file of at most max_file_bytes.
Bytes read_file(const std::string& path);

bool is_data_uri(const std::string& uri);
std::string percent_decode(std::string_view text);

// What a URI of the scene at `scene_path` names: a base64 data URI or a file below the scene's
// folder. Absolute paths, other schemes, "..", directories and links out of the folder are refused.
Bytes read_uri(const std::string& scene_path, const std::string& uri);

// The JSON text and, of a GLB, the binary chunk. Both point into the file's bytes.
struct Container {
    std::string_view json;
    ByteSpan binary;
};
Container split_container(ByteSpan file, const std::string& path);

// Throws when brackets nest deeper than max_json_depth: the parser recurses and its stack would
// end.
void check_json_depth(std::string_view json, const std::string& path);

}  // namespace midway::gltf
