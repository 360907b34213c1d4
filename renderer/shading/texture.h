// Reading textures and turning a material into a Bsdf at a point.
#pragma once

#include <memory>
#include <vector>

#include "math/frame.h"
#include "shading/bsdf.h"
#include "shading/material.h"

namespace midway {

using TextureSet = std::vector<std::shared_ptr<const TextureImage>>;

// What the surface offers to its material at one point.
struct ShadingPoint {
    vec3 ng{0, 0, 1};          // geometric normal of the front side, unit
    vec3 normal{0, 0, 1};      // interpolated, unit
    vec4 tangent{0, 0, 0, 1};  // interpolated; xyz zero where there is none; w the handedness
    vec2 uv[2] = {vec2(0), vec2(0)};
    vec4 color{1};      // vertex colour
    bool thin = false;  // the mesh is a sheet, not the surface of a body
};

enum class ColorSpace : std::uint8_t { linear, srgb };

// Bilinear or nearest. RGB is converted to linear before it is interpolated.
vec4 look_up_texture(const TextureSet& textures, const TextureRef& ref, const ShadingPoint& point,
                     ColorSpace space);

// The same; white where unused.
inline vec4 sample_texture(const TextureSet& textures, const TextureRef& ref,
                           const ShadingPoint& point, ColorSpace space) {
    return ref.used() ? look_up_texture(textures, ref, point, space) : vec4(1);
}

// Coverage in [0, 1] after the alpha mode: the probability that a ray meets the surface.
float material_alpha(const Material& m, const TextureSet& textures, const ShadingPoint& point);

// Radiance that leaves the front side (both sides where double_sided).
vec3 material_emission(const Material& m, const TextureSet& textures, const ShadingPoint& point);

Bsdf make_bsdf(const Material& m, const TextureSet& textures, const ShadingPoint& point);

// Whether lobes that mirror may be Dirac deltas somewhere: textures can only lower the roughness
// below its factor.
bool may_be_smooth(const Material& m);

}  // namespace midway
