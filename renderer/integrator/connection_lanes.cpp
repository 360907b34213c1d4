#include "integrator/edge_lanes.h"
#include "integrator/estimator_lanes.h"

namespace midway {
namespace {

// One lane's in all lanes. Who asks knows already which lanes can be connected.
BsdfLanes spread(const BsdfLanes& b, int lane) {
    BsdfLanes r;
    r.ng = all_lanes(b.ng[lane]);
    r.normal = all_lanes(b.normal[lane]);
    r.diffuse = all_lanes(b.diffuse[lane]);
    if (!b.others[lane]) return r;
    r.others = every_lane;
    r.other.fill(b.other[lane]);
    return r;
}
VertexLanes spread(const VertexLanes& v, int lane) {
    VertexLanes r;
    r.surface = {all_lanes(v.surface.position[lane]), all_lanes(v.surface.error[lane]),
                 spread(v.surface.bsdf, lane)};
    r.to_previous = all_lanes(v.to_previous[lane]);
    r.throughput = all_lanes(v.throughput[lane]);
    r.mis = {all_lanes(v.mis.vcm[lane]), all_lanes(v.mis.vc[lane])};
    r.index = v.index;
    return r;
}

// Lane k has what lane k + shift had.
BsdfLanes rotated(const BsdfLanes& b, int shift) {
    const Mask8 from = rotation(shift);
    BsdfLanes r;
    r.ng = rotate(b.ng, from);
    r.normal = rotate(b.normal, from);
    r.diffuse = rotate(b.diffuse, from);
    r.others = rotate(b.others, from);
    for_each_lane(r.others, [&](int k) { r.other[k] = b.other[(k + shift) % lane_count]; });
    return r;
}
VertexLanes rotated(const VertexLanes& v, int shift) {
    const Mask8 from = rotation(shift);
    VertexLanes r;
    r.surface = {rotate(v.surface.position, from), rotate(v.surface.error, from),
                 rotated(v.surface.bsdf, shift)};
    r.to_previous = rotate(v.to_previous, from);
    r.throughput = rotate(v.throughput, from);
    r.mis = {rotate(v.mis.vcm, from), rotate(v.mis.vc, from)};
    r.index = v.index;
    return r;
}

struct Choosing {
    Choice<Double8> among;
    ConnectionLanes chosen;
};

// As offer_connection(), in lanes where both vertices are connectible. `first`: these are the first
// rough surfaces of their walks.
void offer_connections(const Estimator& e, const VertexLanes& v, const VertexLanes& l, Mask8 lanes,
                       bool first, Choosing& choosing) {
    e.at(Work::shading);
    const Strategy strategy{v.index + 1, l.index + 1};
    const SurfaceLanes &p = v.surface, &q = l.surface;
    const Vec3x8 d = q.position - p.position;
    const Float8 d2 = length_squared(d);
    const Vec3x8 direction = d / sqrt(d2);
    lanes &= (d2 > 0) & may_scatter(p.bsdf, v.to_previous, direction) &
             may_scatter(q.bsdf, l.to_previous, -direction);
    if (!any(lanes)) return;
    const BsdfEval8 fv = eval_bsdfs(p.bsdf, lanes, v.to_previous, direction, Transport::radiance);
    lanes &= ~is_black(fv.f);
    const BsdfEval8 fl =
        eval_bsdfs(q.bsdf, lanes, l.to_previous, -direction, Transport::importance);
    lanes &= ~is_black(fl.f);
    const Double8 cos_v = to_double(abs_dot(p.bsdf.ng, direction));
    const Double8 near = all_lanes(1.0) / to_double(d2);
    const Double8 g_v = cos_v * near, g_l = to_double(abs_dot(q.bsdf.ng, direction)) * near;
    const double scale = 1 / (e.connection_share * (first ? lane_count : 1));
    const Vec3x8 value =
        v.throughput * fv.f * fl.f * l.throughput * to_float(cos_v * g_l * all_lanes(scale));
    e.at(Work::weights);
    const mis::Side8 camera{
        to_double(fl.pdf_fwd_w) * g_v, to_double(fv.pdf_rev_w),
        count_in_lanes(e, {strategy.s - 1, strategy.t + 1}, v.rough == v.index - 1)};
    const mis::Side8 light{to_double(fv.pdf_fwd_w) * g_l, to_double(fl.pdf_rev_w),
                           all_lanes(e.count({strategy.s + 1, strategy.t - 1}, 0, false))};
    const Double8 weight = mis::connection(v.mis, camera, l.mis, light, e.connections(first));
    const Double8 importance = importance_of(value, weight);
    const Mask8 takes = choosing.among.offer(select(lanes, importance, all_lanes(0.0))) & lanes;
    FoundLanes& f = choosing.chosen.found;
    f.lanes |= takes;
    f.t = takes ? Mask8{} + strategy.t : f.t;
    f.value = select(takes, value, f.value);
    f.weight = select(takes, weight, f.weight);
    RayLanes& edges = choosing.chosen.edges;
    const Vec3x8 from = leave(p, d), to = arrive_at(q, p.position);
    edges.origin = select(takes, from, edges.origin);
    edges.direction = select(takes, to - from, edges.direction);
}

}  // namespace

template <Facts F>
ConnectionLanes choose_connections(const Estimator& e, const VertexLanes& v, bool first,
                                   const Double8& numbers, const LightVertices& light, int j,
                                   int last) {
    static_assert(F.one_power2);
    Choosing choosing{.among = {numbers}, .chosen = {}};
    const Mask8 lanes = v.connectible & at_first_rough(v, first);
    for (; j <= last; ++j) {
        const VertexLanes& l = light.vertex(j);
        if (first) {
            for_each_lane(l.connectible, [&](int k) {
                offer_connections(e, v, spread(l, k), lanes, true, choosing);
            });
        } else {
            const int shift = partner(0, v.index, j, lane_count);
            const Mask8 met = lanes & rotate(l.connectible, rotation(shift));
            if (any(met)) offer_connections(e, v, rotated(l, shift), met, false, choosing);
        }
    }
    ConnectionLanes& chosen = choosing.chosen;
    chosen.found.s = v.index + 1;
    chosen.found.value = chosen.found.value * to_float(choosing.among.factor());
    chosen.edges.tfar = all_lanes(1.0f);
    return chosen;
}

template decltype(choose_connections<power2_facts>) choose_connections<power2_facts>;

}  // namespace midway
