#include "shading/bsdf_lanes.h"

#include "math/warp.h"

namespace midway {
namespace {

// draw_diffuse() of bsdf_sample.cpp.
Vec3x8 draw_lambert(const BsdfLanes& b, const Vec3x8& u, const Float8& gf) {
    Vec3x8 local = square_to_cosine_hemisphere(u.x, u.y);
    local.z = select(gf > 0, local.z, -local.z);
    const Vec3x8 to = frames_from_normals(b.normal).to_world(local);
    return select(dot(to, b.ng) * gf < 0, -to, to);
}

}  // namespace

Mask8 connectible(const BsdfLanes& b) {
    Mask8 c = ~is_black(b.diffuse);
    for_each_lane(b.others, [&](int k) { c[k] = b.other[k]->connectible() ? -1 : 0; });
    return c;
}

void let_others_scatter(const BsdfLanes& b, Mask8& may) {
    for_each_lane(b.others, [&](int k) {
        if (b.other[k]->has_glass()) may[k] = -1;
    });
}

void eval_others(const BsdfLanes& b, const Mask8& wanted, const Vec3x8& from, const Vec3x8& to,
                 Transport transport, BsdfEval8& e) {
    for_each_lane(wanted & b.others, [&](int k) {
        const BsdfEval one = eval_bsdf(*b.other[k], from[k], to[k], transport);
        e.f.set(k, one.f);
        e.pdf_fwd_w[k] = one.pdf_fwd_w;
        e.pdf_rev_w[k] = one.pdf_rev_w;
    });
}

BsdfSample8 sample_bsdfs(const BsdfLanes& b, const Mask8& wanted, const Vec3x8& from,
                         const Vec3x8& u, Transport transport) {
    BsdfSample8 s;
    const Float8 gf = dot(from, b.ng);
    s.to = draw_lambert(b, u, gf);
    const BsdfEval8 e = eval_lambert(b, from, s.to, transport);
    s.drawn = wanted & ~b.others & (gf != 0) & (e.pdf_fwd_w > 0) & ~is_black(e.f);
    s.weight = e.f * (abs_dot(s.to, b.ng) / e.pdf_fwd_w);
    s.pdf_fwd_w = e.pdf_fwd_w;
    s.pdf_rev_w = e.pdf_rev_w;
    s.eta_scale = all_lanes(1.0f);
    s.delta = no_lane;
    for_each_lane(wanted & b.others, [&](int k) {
        const auto one = sample_bsdf(*b.other[k], from[k], u[k], transport);
        if (!one) return;
        s.drawn[k] = -1;
        s.delta[k] = one->delta ? -1 : 0;
        s.to.set(k, one->to);
        s.weight.set(k, one->weight);
        s.pdf_fwd_w[k] = one->pdf_fwd_w;
        s.pdf_rev_w[k] = one->pdf_rev_w;
        s.eta_scale[k] = one->eta_scale;
    });
    return s;
}

}  // namespace midway
