// Materials and textures as glTF 2.0 defines them (metallic-roughness with the KHR extensions named
// below), plain data. make_bsdf() in shading/texture.h turns one into a Bsdf at a point.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "math/vector.h"

namespace midway {

// Texels as the file holds them, 8 bits a channel, rows from the top, always four channels.
struct TextureImage {
    std::string name;
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // width * height * 4
};

enum class Wrap : std::uint8_t { repeat, clamp, mirror };

// A use of an image. image < 0: no texture, every channel reads as 1. `rows` is the upper part of
// the 3x3 matrix of KHR_texture_transform: uv' = (dot(rows[0], (u,v,1)), dot(rows[1], (u,v,1))).
struct TextureRef {
    int image = -1;
    int texcoord = 0;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false;
    vec3 rows[2] = {{1, 0, 0}, {0, 1, 0}};
    bool used() const { return image >= 0; }
    bool operator==(const TextureRef&) const = default;
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

// glTF metallic-roughness, KHR_materials_emissive_strength, _transmission, _ior, _specular.
struct Material {
    std::string name;
    vec3 base_color{1};
    float alpha = 1;
    TextureRef base_color_texture;  // sRGB, alpha in a
    float metallic = 1, roughness = 1;
    TextureRef metallic_roughness_texture;  // linear; g roughness, b metallic
    TextureRef normal_texture;              // linear, tangent space
    float normal_scale = 1;
    vec3 emission{0};         // emissiveFactor * emissiveStrength: radiance
    vec3 emissive_factor{0};  // as the file parts `emission`; only editors look at these two
    float emissive_strength = 1;
    TextureRef emission_texture;  // sRGB
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;  // emission leaves a single-sided triangle by its front only
    float transmission = 0;
    TextureRef transmission_texture;  // linear, r
    float ior = 1.5f;
    float specular = 1;           // 0: pure Lambert
    TextureRef specular_texture;  // linear, a
    vec3 specular_color{1};
    TextureRef specular_color_texture;  // sRGB
    bool has_thickness = false;  // KHR_materials_volume with thicknessFactor > 0: a solid body
};

// Every place for a texture that a material has, used or not.
inline std::array<const TextureRef*, 7> texture_refs(const Material& m) {
    return {&m.base_color_texture,    &m.metallic_roughness_texture, &m.normal_texture,
            &m.emission_texture,      &m.transmission_texture,       &m.specular_texture,
            &m.specular_color_texture};
}

}  // namespace midway
