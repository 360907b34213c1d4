#include "shading/bsdf_lanes.h"

#include "math/warp.h"

namespace midway {
namespace {

// eval_bsdf() of Lambert's lobe.
BsdfEval8 eval_lambert(const BsdfLanes& b, const Vec3x8& from, const Vec3x8& to,
                       Transport transport) {
    const bool radiance = transport == Transport::radiance;
    const Vec3x8& o = radiance ? from : to;
    const Vec3x8& i = radiance ? to : from;
    const Float8 go = dot(o, b.ng), gi = dot(i, b.ng);
    const Mask8 reflects = (go * gi > 0) & ~is_black(b.diffuse);
    const Float8 mu_o = abs_dot(b.normal, o), mu_i = abs_dot(b.normal, i), zero{};
    const Vec3x8 f = b.diffuse * (inv_pi * mu_i) / abs(gi);
    const Float8 pdf_light = select(reflects, mu_i * inv_pi, zero);
    const Float8 pdf_camera = select(reflects, mu_o * inv_pi, zero);
    return {select(reflects, f, Vec3x8{}), radiance ? pdf_light : pdf_camera,
            radiance ? pdf_camera : pdf_light};
}

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

BsdfEval8 eval_bsdfs(const BsdfLanes& b, const Mask8& wanted, const Vec3x8& from, const Vec3x8& to,
                     Transport transport) {
    BsdfEval8 e = eval_lambert(b, from, to, transport);
    for_each_lane(wanted & b.others, [&](int k) {
        const BsdfEval one = eval_bsdf(*b.other[k], from[k], to[k], transport);
        e.f.set(k, one.f);
        e.pdf_fwd_w[k] = one.pdf_fwd_w;
        e.pdf_rev_w[k] = one.pdf_rev_w;
    });
    return e;
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
