// Isotropic GGX microfacets and Fresnel terms, in a local frame whose z is the macrosurface normal.
// Sources: Walter et al. 2007 (distribution, refraction), Heitz 2014 (masking), Heitz 2018 and
// Dupuy & Benyoub 2023 (visible normals), Schlick 1994. `alpha` is roughness squared and at least
// smooth_alpha; below that a lobe is a Dirac delta.
#pragma once

#include "math/warp.h"

namespace midway {

// Below this width the float rounding of directions (1e-7) is no longer small against the lobe, so
// the lobe is treated as perfectly smooth (roughness below 0.032).
inline constexpr float smooth_alpha = 1e-3f;

// Density of microfacet normals, eq. 33 of Walter et al., written so that it stays accurate for
// narrow lobes: sin^2 comes from x and y and not from 1 - z^2.
inline float ggx_d(const vec3& h, float alpha) {
    const float a2 = alpha * alpha;
    const float t = h.z * h.z + (h.x * h.x + h.y * h.y) / a2;
    return inv_pi / (a2 * t * t);
}

// Smith's Lambda (Heitz 2014, eq. 72).
inline float ggx_lambda(const vec3& w, float alpha) {
    const float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5f * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}

inline float ggx_g1(const vec3& w, float alpha) { return 1 / (1 + ggx_lambda(w, alpha)); }

// Masking and shadowing correlated by height (Heitz 2014, eq. 99).
inline float ggx_g2(const vec3& o, const vec3& i, float alpha) {
    return 1 / (1 + ggx_lambda(o, alpha) + ggx_lambda(i, alpha));
}

// A normal visible from w, w.z > 0: a uniform point on the spherical cap of half vectors in the
// stretched configuration (Dupuy & Benyoub 2023).
inline vec3 sample_ggx_visible(const vec3& w, float alpha, const vec2& u) {
    const vec3 stretched = glm::normalize(vec3(alpha * w.x, alpha * w.y, w.z));
    const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
    const float r = safe_sqrt((1 - z) * (1 + z));
    const float phi = 2 * pi * u.x;
    const vec3 h = vec3(r * std::cos(phi), r * std::sin(phi), z) + stretched;
    return glm::normalize(vec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-12f)));
}

// (1 - cos)^5, the weight that Schlick's approximation gives to f90.
inline float schlick_weight(float cos_theta) {
    const float m = std::clamp(1 - cos_theta, 0.0f, 1.0f);
    const float m2 = m * m;
    return m2 * m2 * m;
}

// Unpolarised Fresnel reflectance of a dielectric for cos_i >= 0; eta is the index of the far side
// over that of the near side. One for total internal reflection.
inline float fresnel_dielectric(float cos_i, float eta) {
    const float sin2_t = (1 - cos_i) * (1 + cos_i) / (eta * eta);
    if (sin2_t >= 1) return 1;
    const float cos_t = std::sqrt(1 - sin2_t);
    const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

}  // namespace midway
