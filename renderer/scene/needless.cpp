#include "scene/needless.h"

#include "shading/texture.h"

namespace midway {
namespace {

int add_image(Scene& s, std::uint8_t value) {
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 2;
    image->rgba.assign(4 * 4, value);
    s.textures.push_back(std::move(image));
    return static_cast<int>(s.textures.size()) - 1;
}

void fill(TextureRef& place, int image) {
    if (!place.used()) place.image = image;
}

// Whether scene_features() would say the same if the material let light through by a texture: it
// has a mirroring lobe as it is, or gains no smooth one and has a diffuse one already.
bool may_transmit(const Material& m) {
    if (m.transmission > 0) return false;
    if (m.specular > 0 || m.metallic > 0) return true;
    return !may_be_smooth(m) && max_component(m.base_color) > 0;
}

void add_transmission(Scene& s) {
    const int black = add_image(s, 0);
    for (Material& m : s.materials) {
        if (!may_transmit(m)) continue;
        m.transmission = 1;
        m.transmission_texture.image = black;
    }
}

}  // namespace

void add_needless_textures(Scene& s, const NeedlessWork& needless) {
    if (needless.transmission) add_transmission(s);
    if (!needless.textures && !needless.normal_maps) return;
    const int white = add_image(s, 255);
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
