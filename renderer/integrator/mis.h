// Multiple importance sampling weights by recursion: equations (18) to (38) of the seed document
// ("Practical implementation of MIS in Bidirectional Path Tracing"), for any exponent b >= 0 of the
// heuristic w = (n p)^b / sum (n_i p_i)^b. Pure functions of pdfs; no scene.
//
// Each vertex i of a subpath, counted from its end (vertex 0: lens or light), carries two sums,
//   vcm_i = (1 / p_i)^b                                                              (20)
//   vc_i  = (g_{i-1} / p_i)^b (vcm_{i-1} + (p_sigma,i-2)^b vc_{i-1})                 (21)
// with p_i the forward density per area of vertex i, g_{i-1} = cos / d^2 of the reverse direction
// at vertex i-1 and p_sigma,i-2 the reverse density per solid angle from i-1 to i-2. A strategy is
// then weighed by the four cases (26)-(33).
//
// Beyond the seed: a term counts only if its strategy is *feasible* (README, "The method"), which
// is how families, delta vertices and delta lights enter; next event and emission may have
// different densities; not every camera sample needs to have connections, so they have an n of
// their own; x^b of a zero density is zero for every b, also 0.
//
// The renderer computes all of it in double. A heuristic names its number type `Real`, so that the
// audit can run the same lines in float and show where they would have failed.
#pragma once

#include <cmath>
#include <limits>

#include "integrator/strategy.h"

namespace midway::mis {

// A positive number by its natural logarithm: powers of pdfs for large exponents overflow double.
template <class Real>
struct LogNumber {
    Real log = -std::numeric_limits<Real>::infinity();

    friend LogNumber operator*(LogNumber a, LogNumber b) { return {a.log + b.log}; }
    friend LogNumber operator/(LogNumber a, LogNumber b) { return {a.log - b.log}; }
    friend LogNumber operator+(LogNumber a, LogNumber b) {
        const Real high = std::max(a.log, b.log), low = std::min(a.log, b.log);
        if (low == -std::numeric_limits<Real>::infinity()) return {high};
        return {high + std::log1p(std::exp(low - high))};
    }
};

template <class Real>
double to_double(Real x) {
    return x;
}
template <class Real>
double to_double(LogNumber<Real> x) {
    return std::exp(x.log);
}

// x^b of the four kinds of heuristic. Each has the number type that its sums are kept in.
template <class R = double>
struct Uniform {
    using Real = R;
    using Number = R;
    Number operator()(Real x) const { return x > 0 ? Real(1) : Real(0); }
};
template <class R = double>
struct Balance {
    using Real = R;
    using Number = R;
    Number operator()(Real x) const { return x; }
};
template <class R = double>
struct Power2 {
    using Real = R;
    using Number = R;
    Number operator()(Real x) const { return x * x; }
};
template <class R = double>
struct General {
    using Real = R;
    using Number = LogNumber<R>;
    Real exponent = 1;
    Number operator()(Real x) const { return x > 0 ? Number{exponent * std::log(x)} : Number{}; }
};

template <class Real>
Real from_bits(double raw, Real) {
    return static_cast<Real>(raw);
}
template <class Real>
LogNumber<Real> from_bits(double raw, LogNumber<Real>) {
    return {static_cast<Real>(raw)};
}
template <class Real>
double to_bits(Real x) {
    return x;
}
template <class Real>
double to_bits(LogNumber<Real> x) {
    return x.log;
}

// vcm and vc of one exponent, as a vertex stores them (values, or logarithms for General).
struct State {
    double vcm = 0, vc = 0;
};

// Calls `use` with the heuristic of exponent b.
template <class Real = double, class Use>
decltype(auto) with_heuristic(double exponent, Use&& use) {
    if (exponent == 0) return use(Uniform<Real>{});
    if (exponent == 1) return use(Balance<Real>{});
    if (exponent == 2) return use(Power2<Real>{});
    return use(General<Real>{static_cast<Real>(exponent)});
}

template <class H>
struct Terms {
    typename H::Number vcm, vc;
};
template <class H>
Terms<H> load(const State& s) {
    using N = typename H::Number;
    return {from_bits(s.vcm, N{}), from_bits(s.vc, N{})};
}
template <class H>
State store(const Terms<H>& t) {
    return {to_bits(t.vcm), to_bits(t.vc)};
}

// The factor of a term that belongs to a strategy: 1 where it is feasible.
template <class H>
typename H::Number feasible(const H& h, bool yes) {
    return h(yes ? 1 : 0);
}

// Eq. (22), (23): vertex 1 of the camera subpath. p_1 is per area, for one sample per pixel area.
template <class H>
State start_camera(const H& h, double n, double pdf_a) {
    using R = typename H::Real;
    return store<H>({h(R(n) / R(pdf_a)), h(0)});
}

// Eq. (24), (25): vertex 1 of a light subpath. r = next event's density of vertex 0 over
// emission's; g_0 = cos / d^2 at the light, 1 for infinite lights (37). A delta light cannot be
// hit: vc = 0 (34).
struct LightStart {
    double pdf_origin = 0;        // p_0, of emission
    double pdf_a = 0;             // p_1
    double g_light = 0;           // g_0
    double next_event_ratio = 1;  // r
    bool hittable = true;         // in this scene, by the families that the weights count
};
template <class H>
State start_light(const H& h, const LightStart& l) {
    using R = typename H::Real;
    return store<H>({h(R(l.next_event_ratio) / R(l.pdf_a)),
                     l.hittable ? h(R(l.g_light) / R(l.pdf_origin) / R(l.pdf_a)) : h(0)});
}

// The step from vertex i-1 to vertex i. For a delta vertex i-1 the densities are the coefficients
// of its Dirac factors.
struct Step {
    double pdf_fwd_a = 0;  // p_i per area (coefficient * g_i behind a delta vertex)
    double g_rev = 0;      // g_{i-1}: cos at vertex i-1 over d^2
    double pdf_rev_w = 0;  // p_sigma,i-2 at vertex i-1
    bool delta = false;    // vertex i-1 scattered by a delta lobe
    double n = 1;          // of the strategy that vcm_{i-1} stands for: 0 where not feasible; 1 for
                           // light tracing, whose n is in start_camera()
};
// Eq. (20), (21).
template <class H>
State advance(const H& h, const State& previous, const Step& k) {
    using R = typename H::Real;
    const Terms<H> p = load<H>(previous);
    const auto ratio = h(R(k.g_rev) / R(k.pdf_fwd_a));
    const auto rest = h(R(k.pdf_rev_w)) * p.vc;
    if (k.delta) return store<H>({h(0), ratio * rest});
    return store<H>({h(1 / R(k.pdf_fwd_a)), ratio * (h(R(k.n)) * p.vcm + rest)});
}

// w of one side of a connecting edge, eq. (26), (27): pdf_a is the density per area with which the
// *other* side would have made this end vertex, pdf_rev_w the density from it to its own
// predecessor.
struct Side {
    double pdf_a = 0;
    double pdf_rev_w = 0;
    double n = 1;  // of the strategy that moves the edge by one to this side, as in Step
};
template <class H>
typename H::Number side_weight(const H& h, const State& state, const Side& k) {
    using R = typename H::Real;
    const Terms<H> v = load<H>(state);
    return h(R(k.pdf_a)) * (h(R(k.n)) * v.vcm + h(R(k.pdf_rev_w)) * v.vc);
}

template <class H>
double weight_of(const H& h, typename H::Number camera, typename H::Number light) {
    return to_double(h(1) / (camera + h(1) + light));  // eq. (14)
}

// Case 1, s, t >= 2: connection, eq. (26), (27). n: how many of them a camera sample has.
template <class H>
double connection(const H& h, const State& camera, Side camera_side, const State& light,
                  Side light_side, double n) {
    const double share = 1 / n;
    camera_side.pdf_a *= share;
    light_side.pdf_a *= share;
    return weight_of(h, side_weight(h, camera, camera_side), side_weight(h, light, light_side));
}

// Case 2, t = 0: emitter hit, eq. (28), (29). The vcm term is next event's strategy and takes its
// density, the vc term emission's.
struct EmitterHitPdfs {
    double origin = 0, leave = 0, next_event = 0;  // as LightPdfs in scene/light.h
    bool next_event_feasible = true;
};
template <class H>
double emitter_hit(const H& h, const State& camera, const EmitterHitPdfs& k) {
    using R = typename H::Real;
    const Terms<H> v = load<H>(camera);
    const auto by_next_event = h(R(k.next_event)) * feasible(h, k.next_event_feasible) * v.vcm;
    return weight_of(h, by_next_event + h(R(k.origin)) * h(R(k.leave)) * v.vc, h(0));
}

// Case 3, t = 1: next event, eq. (30) divided by r, and (31) over next event's density.
struct NextEventPdfs {
    double next_event = 0;  // density of the light point by next event, as LightPdfs
    double origin = 0;      // by emission
    double hit_pdf = 0;  // p_0 reversed: of the camera side hitting that point (area; solid angle
                         // for infinite lights)
    bool hit_feasible = true;
};
template <class H>
double next_event(const H& h, const State& camera, const Side& camera_side,
                  const NextEventPdfs& k) {
    using R = typename H::Real;
    const auto w_camera = h(R(k.origin) / R(k.next_event)) * side_weight(h, camera, camera_side);
    const auto w_light = feasible(h, k.hit_feasible) * h(R(k.hit_pdf) / R(k.next_event));
    return weight_of(h, w_camera, w_light);
}

// Case 4, s = 1: light tracing, eq. (32), (33).
template <class H>
double light_tracing(const H& h, const State& light, Side light_side, double n) {
    light_side.pdf_a /= n;
    return weight_of(h, h(0), side_weight(h, light, light_side));
}

// Without light subpaths vc is zero, and vcm counts as next event's strategy alone: what eq. (20)
// and the cases 2 and 3 leave of the functions above, with the same bits.
namespace path_tracer {

template <class H>
State advance(const H& h, double pdf_fwd_a, bool delta) {
    using R = typename H::Real;
    return store<H>({delta ? h(0) : h(1 / R(pdf_fwd_a)), h(0)});
}

template <class H>
double emitter_hit(const H& h, const State& camera, const EmitterHitPdfs& k) {
    using R = typename H::Real;
    const auto vcm = load<H>(camera).vcm;
    return weight_of(h, h(R(k.next_event)) * feasible(h, k.next_event_feasible) * vcm, h(0));
}

template <class H>
double next_event(const H& h, const NextEventPdfs& k) {
    using R = typename H::Real;
    return weight_of(h, h(0), feasible(h, k.hit_feasible) * h(R(k.hit_pdf) / R(k.next_event)));
}

}  // namespace path_tracer
}  // namespace midway::mis
