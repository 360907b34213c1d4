#include "scene/needless.h"

namespace midway {
namespace {

std::shared_ptr<const TextureImage> white_image() {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 2;
    image->rgba.assign(4 * 4, 255);
    return image;
}

void fill(TextureRef& place, int image) {
    if (!place.used()) place.image = image;
}

}  // namespace

void add_needless_textures(Scene& s, const NeedlessWork& needless) {
    if (!needless.textures && !needless.normal_maps) return;
    const int white = static_cast<int>(s.textures.size());
    s.textures.push_back(white_image());
    for (Material& m : s.materials) {
        if (needless.textures) {
            fill(m.base_color_texture, white);
            fill(m.specular_texture, white);
            fill(m.specular_color_texture, white);
            if (m.metallic < 1) fill(m.metallic_roughness_texture, white);
            if (m.transmission < 1) fill(m.transmission_texture, white);
        }
        // At scale zero the map's x and y do not count.
        if (needless.normal_maps && !m.normal_texture.used()) {
            m.normal_texture.image = white;
            m.normal_scale = 0;
        }
    }
}

}  // namespace midway
