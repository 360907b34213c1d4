// Decoding of PNG and JPEG images of a glTF file, each at most once and only when a texture asks
// for it. Internal to renderer/io.
#pragma once

#include <memory>
#include <vector>

#include "io/gltf_document.h"
#include "scene/scene_description.h"

namespace midway::gltf {

inline constexpr std::int64_t max_image_texels = std::int64_t{1} << 26;
inline constexpr std::int64_t max_total_texels = std::int64_t{1} << 29;

// Which image of the scene each image of the file became.
struct ImageTable {
    std::vector<int> scene_image;  // not_loaded, unusable or an index into SceneDescription::images
    std::int64_t texels_left = max_total_texels;
};

// Index into scene.images, or -1 with a warning where the image is missing or cannot be decoded.
int load_image(Document& document, ImageTable& table, int image, SceneDescription& scene);

}  // namespace midway::gltf
