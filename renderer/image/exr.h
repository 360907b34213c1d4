// OpenEXR in (writing is write_exr in image.h). Half, float and uint channels, scanline or tiled,
// at full resolution; of several parts the first. The image is the data window: where it lies
// within the display window is not kept.
//
// Channels to layers: R, G, B without a prefix are the main image, or Y alone as grey. PREFIX.R,
// .G, .B (or .X, .Y, .Z) are the layer PREFIX; a channel alone under its prefix is the scalar layer
// PREFIX; any other channel is a scalar layer under its whole name. Alpha beside colour is left
// out. A file with no main image shows its first colour layer, or else its first layer, as such.
// Scalars are spread over red, green and blue.
//
// Throws std::runtime_error with one line "WHAT (WHERE); REMEDY".
#pragma once

#include <cstdint>
#include <string>

#include "image/image.h"

namespace midway {

// Limits of any file, in pixels and in values of all layers together (three a pixel and layer).
inline constexpr int64_t max_image_pixels = int64_t(1) << 28;
inline constexpr int64_t max_image_values = int64_t(1) << 32;

LoadedImage read_exr(const std::string& path);

}  // namespace midway
