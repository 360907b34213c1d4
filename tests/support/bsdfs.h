// One Bsdf of every kind that a material can make, for tests of sampling and of scattering laws.
#pragma once

#include <string>
#include <vector>

#include "shading/texture.h"
#include "support/scenes.h"

namespace midway::test {

struct NamedBsdf {
    std::string name;
    Bsdf bsdf;
};

// At a point whose shading normal is tilted against ng by `tilt` radians.
inline Bsdf bsdf_of(const Material& m, float tilt = 0, bool thin = false) {
    ShadingPoint p;
    p.ng = glm::normalize(vec3(0.3f, -0.5f, 0.8f));
    const Frame f = frame_from_normal(p.ng);
    p.normal = glm::normalize(p.ng + std::tan(tilt) * (f.s * 0.6f + f.t * 0.8f));
    p.thin = thin;
    return make_bsdf(m, {}, p);
}

inline Material mixed_material() {
    Material m = plastic(0.5f, vec3(0.9f, 0.6f, 0.3f));
    m.metallic = 0.3f;
    m.transmission = 0.5f;
    return m;
}

// Lobes that have densities (the mixed ones have all three).
inline std::vector<NamedBsdf> every_bsdf() {
    return {{"diffuse", bsdf_of(lambert(vec3(0.8f, 0.5f, 0.2f)))},
            {"diffuse, tilted", bsdf_of(lambert(vec3(0.8f, 0.5f, 0.2f)), 0.6f)},
            {"plastic 0.2", bsdf_of(plastic(0.2f, vec3(0.5f)))},
            {"plastic 0.5", bsdf_of(plastic(0.5f, vec3(0.5f)))},
            {"plastic 1", bsdf_of(plastic(1, vec3(0.8f)))},
            {"smooth plastic", bsdf_of(plastic(0, vec3(0.5f)))},
            {"metal 0.3", bsdf_of(metal(0.3f, vec3(1, 0.7f, 0.3f)))},
            {"metal 0.8", bsdf_of(metal(0.8f))},
            {"metal 0.5, tilted", bsdf_of(metal(0.5f), 0.4f)},
            {"glass 0.3", bsdf_of(glass(0.3f))},
            {"glass 0.8, index 2.4", bsdf_of(glass(0.8f, 2.4f))},
            {"glass 0.6, index 1.25, tilted", bsdf_of(glass(0.6f, 1.25f), 0.3f)},
            {"thin glass 0.5", bsdf_of(glass(0.5f), 0, true)},
            {"mixed, tilted", bsdf_of(mixed_material(), 0.5f)},
            {"mixed, thin, tilted", bsdf_of(mixed_material(), 0.5f, true)}};
}

// Lobes that are Dirac deltas, alone and beside a diffuse one.
inline std::vector<NamedBsdf> smooth_bsdfs() {
    Material mixed = mixed_material();
    mixed.roughness = 0;
    return {{"mirror", bsdf_of(metal(0, vec3(0.9f, 0.6f, 0.3f)))},
            {"mirror, tilted", bsdf_of(metal(0), 0.4f)},
            {"smooth plastic", bsdf_of(plastic(0, vec3(0.5f)))},
            {"smooth glass", bsdf_of(glass(0))},
            {"smooth glass, index 2.4, tilted", bsdf_of(glass(0, 2.4f), 0.2f)},
            {"rough glass of matched index", bsdf_of(glass(0.5f, 1))},
            {"thin smooth glass", bsdf_of(glass(0), 0, true)},
            {"smooth mixed", bsdf_of(mixed)}};
}

}  // namespace midway::test
