// The weights of mis.h for eight paths at once, exponent 2, in double as there: the same equations
// in the same order, hence the same bits. A strategy that is not feasible has n = 0.
#pragma once

#include "math/lanes.h"

namespace midway::mis {

// vcm and vc.
struct State8 {
    Double8 vcm, vc;
};

inline Double8 square(const Double8& x) { return x * x; }
inline double square(double x) { return x * x; }

// 1 / (camera + 1 + light): eq. (14).
inline Double8 weight_of(const Double8& camera, const Double8& light) {
    const Double8 one = all_lanes(1.0);
    return one / (camera + one + light);
}

// Eq. (20), (21). `n`: of the strategy that vcm_{i-1} stands for.
struct Step8 {
    Double8 pdf_fwd_a, g_rev, pdf_rev_w;
    Mask8 delta;
    Double8 n;
};
inline State8 advance(const State8& p, const Step8& k) {
    const Double8 zero = all_lanes(0.0);
    const Double8 ratio = square(k.g_rev / k.pdf_fwd_a);
    const Double8 rest = square(k.pdf_rev_w) * p.vc;
    const Double8 all = square(k.n) * p.vcm + rest;
    return {select(k.delta, zero, square(all_lanes(1.0) / k.pdf_fwd_a)),
            ratio * select(k.delta, rest, all)};
}

// One side of a connecting edge, eq. (26), (27).
struct Side8 {
    Double8 pdf_a, pdf_rev_w, n;
};
inline Double8 side_weight(const State8& s, const Side8& k) {
    return square(k.pdf_a) * (square(k.n) * s.vcm + square(k.pdf_rev_w) * s.vc);
}

// Case 1. `n`: of connections.
inline Double8 connection(const State8& camera, Side8 camera_side, const State8& light,
                          Side8 light_side, double n) {
    const Double8 share = all_lanes(1 / n);
    camera_side.pdf_a = camera_side.pdf_a * share;
    light_side.pdf_a = light_side.pdf_a * share;
    return weight_of(side_weight(camera, camera_side), side_weight(light, light_side));
}

// Case 3, eq. (30) divided by r, and (31). Where the light cannot be hit, `hit_pdf` counts as zero.
struct NextEvent8 {
    Double8 next_event, origin, hit_pdf;
    Mask8 hit_feasible;

    Double8 light_weight() const {
        return select(hit_feasible, square(hit_pdf / next_event), all_lanes(0.0));
    }
};
inline Double8 next_event(const State8& camera, const Side8& camera_side, const NextEvent8& k) {
    return weight_of(square(k.origin / k.next_event) * side_weight(camera, camera_side),
                     k.light_weight());
}

// Case 4, eq. (32), (33). `n`: of light tracing.
inline Double8 light_tracing(const State8& light, Side8 side, double n) {
    side.pdf_a = side.pdf_a / all_lanes(n);
    return weight_of(all_lanes(0.0), side_weight(light, side));
}

// Without light subpaths (mis::path_tracer).
namespace path_tracer {

inline State8 advance(const Double8& pdf_fwd_a, const Mask8& delta) {
    return {select(delta, all_lanes(0.0), square(all_lanes(1.0) / pdf_fwd_a)), all_lanes(0.0)};
}
inline Double8 next_event(const NextEvent8& k) {
    return weight_of(all_lanes(0.0), k.light_weight());
}

}  // namespace path_tracer
}  // namespace midway::mis
