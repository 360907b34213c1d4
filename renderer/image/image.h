// Images in memory: linear scene-referred RGB in float, rows from the top. Throws
// std::runtime_error with one line "WHAT (WHERE); REMEDY" for anything that cannot be read or
// written.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "math/vector.h"

namespace midway {

struct Image {
    int width = 0, height = 0;
    std::vector<vec3> pixels;  // row by row from the top, width * height

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(static_cast<size_t>(w) * h, vec3(0)) {}
    vec3& at(int x, int y) { return pixels[static_cast<size_t>(y) * width + x]; }
    const vec3& at(int x, int y) const { return pixels[static_cast<size_t>(y) * width + x]; }
};

// One named layer of an EXR file. An empty name is the main layer (channels R, G, B); otherwise the
// channels are NAME.R, NAME.G, NAME.B, or NAME.V alone where `scalar` is set (the red part is
// kept).
struct ImageLayer {
    std::string name;
    Image image;
    bool scalar = false;
};

using Metadata = std::map<std::string, std::string>;

// An image that a file held: its main RGB layer, every named layer, and the text attributes.
struct LoadedImage {
    Image image;
    std::vector<ImageLayer> layers;
    Metadata metadata;
};

// Linear RGB from EXR or Radiance HDR, chosen by the file's content and not by its name. Sizes are
// checked before memory is taken (at most 2^28 pixels).
LoadedImage read_image(const std::string& path);

// Float EXR, ZIP-compressed, with the metadata as string attributes. All layers have one size.
// Appears whole or not at all: written beside, then renamed.
void write_exr(const std::string& path, const std::vector<ImageLayer>& layers,
               const Metadata& metadata);

}  // namespace midway
