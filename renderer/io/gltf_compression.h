// EXT_meshopt_compression and KHR_draco_mesh_compression undone before parsing: decoded data goes
// into new buffers, and views, accessors and primitives of the JSON are pointed at them, so that
// nothing later knows of compression. Internal to renderer/io. Throws std::runtime_error "WHAT
// (FILE); REMEDY".
#pragma once

#include "io/gltf_json.h"

namespace midway::gltf {

// Bytes that decompression of one file may produce: a few bytes can expand to gigabytes.
inline constexpr std::uint64_t max_decoded_bytes = 1ull << 31;

void decode_meshopt(RawDocument& document);
void decode_draco(RawDocument& document);

}  // namespace midway::gltf
