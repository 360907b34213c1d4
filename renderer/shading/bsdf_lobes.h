// What bsdf.cpp (values and densities) and bsdf_sample.cpp (sampling) share; nobody else includes
// it.
//
// Where the shading normal ns and the geometric normal ng disagree about the side of a direction,
// the microfacet and glass lobes are folded instead of cut, so that no energy is lost and no black
// rims appear. With o towards the camera and i towards the light, and in the shading frame mirrored
// so that o lies above by ng:
//   - the lobe is entered with ao = (o.x, o.y, |o.z|);
//   - what the lobe sends to the wrong side of ng is mirrored at ng's plane. So i receives from the
//     lobe's directions w = i and w = mirror(i), each if it lies on the lobe's own side of ns.
// This is a function of the path alone: f(o, i) |i . ng| = sum over w of L(ao, w) |w . ns|, whose
// integral over i is the lobe's albedo at ao. From i the two w, and the two o that fold to one ao,
// are chosen with equal probability.
#pragma once

#include "shading/albedo_table.h"
#include "shading/bsdf.h"
#include "shading/microfacet.h"

namespace midway::lobes {

// The shading frame as one of the directions sees it: mirrored where that direction is behind ng,
// so that it lies above; `n` is ng on that side.
struct SideFrame {
    bool front = true;
    vec3 n{0, 0, 1};
};

inline vec3 to_local(const Bsdf& b, const vec3& w, bool front) {
    vec3 l = b.frame.to_local(w);
    if (!front) l.z = -l.z;
    return l;
}
inline vec3 to_world(const Bsdf& b, vec3 l, bool front) {
    if (!front) l.z = -l.z;
    return b.frame.to_world(l);
}
inline SideFrame side_frame(const Bsdf& b, bool front) {
    return {front, to_local(b, front ? b.ng : -b.ng, front)};
}
inline vec3 mirror(const SideFrame& s, const vec3& w) { return w - 2 * glm::dot(s.n, w) * s.n; }
inline vec3 above(const vec3& w) { return {w.x, w.y, std::abs(w.z)}; }

// Index beyond the surface over that on this side.
// A thin sheet shows its outer face on both sides.
inline float eta_beyond(const Bsdf& b, bool front) { return front || b.thin ? b.eta : 1 / b.eta; }

// The lobe's directions that end in the light-side direction i, in i's own frame (above: z > 0).
struct LightSide {
    vec3 w[2];
    int count = 0;
};
inline LightSide light_side(const SideFrame& s, const vec3& i) {
    LightSide l;
    if (i.z > 0) l.w[l.count++] = i;
    const vec3 m = mirror(s, i);
    if (m.z > 0) l.w[l.count++] = m;
    return l;
}
// The cosine by which lobes are chosen at i; 0 where only diffuse light arrives.
inline float light_cosine(const LightSide& l) { return l.count ? std::min(1.0f, l.w[0].z) : 0.0f; }

// How many camera-side directions on o's side of ng fold to the same ao.
inline int camera_folds(const SideFrame& s, const vec3& o) {
    return glm::dot(s.n, vec3(o.x, o.y, -o.z)) * glm::dot(s.n, o) > 0 ? 2 : 1;
}

// Probabilities with which sampling picks a lobe at cosine z (0: only diffuse light is left).
struct LobeChoice {
    float diffuse = 0, specular = 0, glass = 0;
};

// What the specular lobe or the coat takes at a cosine, and what is left for the layer below:
// looked up once for all who ask.
struct LayerAlbedo {
    SchlickAlbedo specular;
    float below = 1;
};
LayerAlbedo layer_albedo(const Bsdf& b, float mu);

LobeChoice choose_lobes(const Bsdf& b, float z, const LayerAlbedo& at_z);
inline LobeChoice choose_lobes(const Bsdf& b, float z) {
    return choose_lobes(b, z, b.only_diffuse ? LayerAlbedo{} : layer_albedo(b, z));
}

// Reflectance of one interface, or of a thin sheet with all orders of internal reflection.
inline float glass_reflectance(const Bsdf& b, float cos_h, float eta) {
    const float r = fresnel_dielectric(std::min(cos_h, 1.0f), eta);
    return b.thin ? 2 * r / (1 + r) : r;
}

inline vec3 specular_fresnel(const Bsdf& b, float cos_h) {
    return b.f0 + (b.f90 - b.f0) * schlick_weight(cos_h);
}

}  // namespace midway::lobes
