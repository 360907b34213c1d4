// Scattering at one surface point, by value: a sum of three lobes
//   diffuse     Lambert, dimmed in both directions by what the coat above it reflects
//   specular    GGX reflection with Schlick's Fresnel term (metal, and the coat of plastics)
//   glass       GGX dielectric, reflection and transmission; solid or thin-walled
// each of which may be absent. Narrow lobes are Dirac deltas.
//
// All directions point away from the surface. f is the *path's* function: with o the direction
// towards the camera and i towards the light,
//   f(o, i) = f_s(o, i) * |i . ns| / |i . ng|,
// so that a path's contribution is the product of f and of |cos| factors taken with the geometric
// normal ng, whichever side built it (Veach 1997, section 5.3; the shading-normal correction of the
// light side and the eta^2 of refraction of the camera side are thereby inside). Transport tells
// which of the two given directions is o. Radiance is scaled by (eta_o / eta_i)^2 at refraction.
//
// Reflection and transmission are told apart by ng. Where ns and ng disagree about the side of a
// direction, lobes are folded and not cut: the albedo stays exact for every tilt of ns
// (bsdf_lobes.h says how).
#pragma once

#include <optional>

#include "math/frame.h"
#include "math/vector.h"

namespace midway {

// What a subpath carries away from its first vertex: the camera's walk gathers radiance, the
// light's walk spreads importance's dual.
enum class Transport : std::uint8_t { radiance, importance };

struct Bsdf {
    Frame frame;                      // z is the shading normal ns, on the side of ng
    vec3 ng{0, 0, 1};                 // geometric normal of the front side
    vec3 diffuse{0};                  // albedo of the Lambert lobe before the coat
    float coat_f0 = 0, coat_f90 = 0;  // largest component of the coat over the diffuse lobe
    vec3 f0{0}, f90{0};               // specular lobe
    float alpha = 1;                  // GGX width of both microfacet lobes
    vec3 glass{0};                    // weight of the glass lobe
    vec3 glass_tint{1};               // of transmitted light, per interface
    float eta = 1.5f;                 // index behind the front side over that before it
    bool thin = false;
    bool only_diffuse = false;  // nothing but Lambert's lobe: most surfaces, and cheap

    bool has_diffuse() const { return !is_black(diffuse); }
    bool has_specular() const { return !is_black(f90) || !is_black(f0); }
    bool has_glass() const { return !is_black(glass); }
    bool smooth() const;
    // Whether two directions chosen by somebody else can have f > 0.
    bool connectible() const {
        return has_diffuse() || ((has_specular() || has_glass()) && !smooth());
    }
    bool empty() const { return !has_diffuse() && !has_specular() && !has_glass(); }
};

// The value for a pair of directions and the densities per solid angle with which sample_bsdf draws
// one given the other. Delta lobes add nothing, but take their share of the probability.
struct BsdfEval {
    vec3 f{0};
    float pdf_fwd_w = 0;  // of `to` given `from`
    float pdf_rev_w = 0;  // of `from` given `to`
};

BsdfEval eval_bsdf(const Bsdf& bsdf, const vec3& from, const vec3& to, Transport transport);

// False where eval_bsdf() is zero for the sides of the surface alone: only glass lets light
// through.
inline bool may_scatter(const Bsdf& b, const vec3& from, const vec3& to) {
    return b.has_glass() || glm::dot(from, b.ng) * glm::dot(to, b.ng) > 0;
}

struct BsdfSample {
    vec3 to{0, 0, 1};
    vec3 weight{0};  // f |to . ng| / pdf_fwd_w; for a delta lobe the ratio of the Dirac factors'
                     // coefficients
    float pdf_fwd_w = 0;  // per solid angle; for a delta lobe the discrete probability
    float pdf_rev_w = 0;
    bool delta = false;
    float eta_scale =
        1;  // (eta_from / eta_to)^2 where `to` crossed into another medium, in radiance transport
};

// Draws `to` given `from`: u.xyz. Empty where the lobes absorb everything or the drawn direction is
// invalid (that sample carries nothing).
std::optional<BsdfSample> sample_bsdf(const Bsdf& bsdf, const vec3& from, const vec3& u,
                                      Transport transport);

// Approximate hemispherical albedo, for the albedo layer and for denoisers.
vec3 approximate_albedo(const Bsdf& bsdf);

}  // namespace midway
