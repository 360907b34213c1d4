// The Bsdfs of eight surface points side by side (bsdf.h). Lambert's lobe alone, which is what most
// surfaces have, is done for all lanes at once; lanes with other lobes go through bsdf.h one by
// one. Both ways give the same bits.
#pragma once

#include <array>

#include "math/lanes.h"
#include "shading/bsdf.h"

namespace midway {

struct BsdfLanes {
    Vec3x8 ng;                                    // geometric normal of the front side
    Vec3x8 normal;                                // shading normal, on the side of ng
    Vec3x8 diffuse;                               // albedo; zero in lanes with other lobes
    Mask8 others{};                               // lanes that have other lobes than Lambert's
    std::array<const Bsdf*, lane_count> other{};  // in those lanes, kept by whoever made this
};
using BsdfStore = std::array<Bsdf, lane_count>;

// Where two directions chosen by somebody else can have f > 0.
Mask8 connectible(const BsdfLanes& b);

// As may_scatter() of bsdf.h.
void let_others_scatter(const BsdfLanes& b, Mask8& may);
inline Mask8 may_scatter(const BsdfLanes& b, const Vec3x8& from, const Vec3x8& to) {
    Mask8 m = dot(from, b.ng) * dot(to, b.ng) > 0;
    if (any(b.others)) let_others_scatter(b, m);
    return m;
}

// As eval_bsdf().
struct BsdfEval8 {
    Vec3x8 f;
    Float8 pdf_fwd_w, pdf_rev_w;
};

// Of Lambert's lobe, in every lane.
inline BsdfEval8 eval_lambert(const BsdfLanes& b, const Vec3x8& from, const Vec3x8& to,
                              Transport transport) {
    const bool radiance = transport == Transport::radiance;
    const Vec3x8& o = radiance ? from : to;
    const Vec3x8& i = radiance ? to : from;
    const Float8 go = dot(o, b.ng), gi = dot(i, b.ng);
    const Mask8 reflects = (go * gi > 0) & ~is_black(b.diffuse);
    const Float8 mu_o = abs_dot(b.normal, o), mu_i = abs_dot(b.normal, i), zero{};
    const Vec3x8 f = b.diffuse * (inv_pi * mu_i) * (1.0f / abs(gi));
    const Float8 pdf_light = select(reflects, mu_i * inv_pi, zero);
    const Float8 pdf_camera = select(reflects, mu_o * inv_pi, zero);
    return {select(reflects, f, Vec3x8{}), radiance ? pdf_light : pdf_camera,
            radiance ? pdf_camera : pdf_light};
}

// In the lanes that are wanted.
void eval_others(const BsdfLanes& b, const Mask8& wanted, const Vec3x8& from, const Vec3x8& to,
                 Transport transport, BsdfEval8& e);
inline BsdfEval8 eval_bsdfs(const BsdfLanes& b, const Mask8& wanted, const Vec3x8& from,
                            const Vec3x8& to, Transport transport) {
    BsdfEval8 e = eval_lambert(b, from, to, transport);
    if (any(wanted & b.others)) eval_others(b, wanted, from, to, transport, e);
    return e;
}

// As sample_bsdf().
struct BsdfSample8 {
    Mask8 drawn;
    Mask8 delta;
    Vec3x8 to, weight;
    Float8 pdf_fwd_w, pdf_rev_w, eta_scale;
};
BsdfSample8 sample_bsdfs(const BsdfLanes& b, const Mask8& wanted, const Vec3x8& from,
                         const Vec3x8& u, Transport transport);

}  // namespace midway
