#include "integrator/estimator_lanes.h"

#include "integrator/edge_lanes.h"
#include "scene/light_lanes.h"

namespace midway {
namespace {

// Lanes in which the ray need not be traced to know that nothing arrives.
Mask8 is_nothing(const FoundLanes& f) { return is_black(f.value) | ~not_zero(f.weight); }

}  // namespace

void let_arrive(const Estimator& e, FoundLanes& f, const RayLanes& edges, RayCounts& rays) {
    if (rays.by_strategy)
        for_each_lane(f.lanes, [&](int k) { rays.count_shadow(f.strategy(k)); });
    else
        rays.shadow += static_cast<unsigned>(std::popcount(bits(f.lanes)));
    e.at(Work::rays);
    const Float8 part = e.scene->accel->transmittance(edges, f.lanes, {e.scene});
    e.at(Work::other);
    f.value = f.value * part;
    f.lanes &= part > 0;
}

template <Facts F>
FoundLanes hit_lights(const Estimator& e, const WalkLanes& w, const VertexLanes& v) {
    const Strategy strategy{w.index + 1, 0};
    FoundLanes found = nothing_of(strategy);
    if (!e.families.emitter_hit && !(strategy.s == 2 && e.direct_lamps)) return found;
    const auto add = [&](int k, const std::optional<EmitterHit>& hit) {
        if (!hit) return;
        const mis::State sums{w.mis.vcm[k], w.mis.vc[k]};
        const Contribution c = weigh_hit<F>(e, *hit, strategy, w.throughput[k], &sums);
        found.lanes[k] = -1;
        found.value.set(k, c.value);
        found.weight.set(k, c.weights[0]);
    };
    const Scene& s = *e.scene;
    for_each_lane(w.surface, [&](int k) {
        const TriangleHit& hit = w.hits[k];
        if (s.first_light[hit.object] < 0) return;
        const SurfacePoint p = surface_point(s.geometry->objects[hit.object], hit);
        add(k, emitter_hit(s, p, v.to_previous[k], w.previous_position[k]));
    });
    if (s.sky_light >= 0) for_each_lane(w.sky, [&](int k) { add(k, sky_hit(s, w.direction[k])); });
    return found;
}

template <Facts F>
FoundLanes connect_to_lights(const Estimator& e, const VertexLanes& v,
                             const std::array<Float8, 4>& u, RayCounts& rays) {
    e.at(Work::shading);
    const SurfaceLanes& p = v.surface;
    const Strategy strategy{v.index + 1, 1};
    FoundLanes c = nothing_of(strategy);
    const NextEventLanes n = sample_next_events(*e.scene, v.connectible, p.position,
                                                {fine_numbers(u[0], u[3]), u[1], u[2]});
    if (!any(n.found)) return c;
    const BsdfEval8 f =
        eval_bsdfs(p.bsdf, n.found, v.to_previous, n.direction, Transport::radiance);
    c.lanes = n.found & ~is_black(f.f);
    const Float8 cos = abs_dot(p.bsdf.ng, n.direction);
    const Double8 cos_v = to_double(cos), distance2 = to_double(n.distance_squared);
    const int edges = strategy.edges(), count = e.next_events(edges);
    c.value = v.throughput * f.f * n.value * to_float(cos_v / all_lanes(double(count)));

    const Double8 g_light = to_double(n.cos_theta) / distance2;
    e.at(Work::weights);
    const mis::NextEvent8 pdfs{to_double(n.next_event) * all_lanes(double(count)),
                               to_double(n.origin), to_double(f.pdf_fwd_w) * g_light,
                               e.weighed[0].emitter_hit ? ~n.delta : no_lane};
    if constexpr (F.path_tracer) {
        c.weight = mis::path_tracer::next_event(pdfs);
    } else {
        const Double8 pdf_a = to_double(n.leave) * cos_v / distance2 * all_lanes(e.share_of(edges));
        const Double8 n =
            count_in_lanes(e, {strategy.s - 1, strategy.t + 1}, v.rough == v.index - 1);
        c.weight = mis::next_event(v.mis, {pdf_a, to_double(f.pdf_rev_w), n}, pdfs);
    }
    const Vec3x8 from = leave(p, n.direction);
    const Vec3x8 to = offset_end(n.target, n.normal, n.error, p.position);
    const Float8 open = all_lanes(std::numeric_limits<float>::infinity());
    c.lanes &= ~is_nothing(c);
    let_arrive(e, c,
               {from, select(n.infinite, n.direction, to - from),
                select(n.infinite, open, all_lanes(1.0f))},
               rays);
    return c;
}

template <Facts F>
SplatLanes connect_to_camera(const Estimator& e, const VertexLanes& l,
                             const std::array<Float8, 4>& u, RayCounts& rays) {
    e.at(Work::shading);
    SplatLanes s;
    const Strategy strategy{1, l.index + 1};
    FoundLanes& c = s.found = nothing_of(strategy);
    const SurfaceLanes& p = l.surface;
    const Vec3x8 lens = lens_points(e.camera, l.connectible, u[0], u[1]);
    const Vec3x8 d = lens - p.position;
    const Float8 d2 = length_squared(d);
    const Vec3x8 direction = d / sqrt(d2);
    const Float8 along = dot(-direction, all_lanes(e.camera.forward));
    c.lanes =
        l.connectible & (d2 > 0) & may_scatter(p.bsdf, l.to_previous, direction) & (along > 0);
    Float8 factor{};
    for_each_lane(c.lanes, [&](int k) {
        const auto film = film_position(e.camera, lens[k], -direction[k]);
        s.pixels[k] = choose_splat_pixel(e.filter, *film, {u[2][k], u[3][k]});
        factor[k] = s.pixels[k].factor;
        if (!e.crop.contains(s.pixels[k].x, s.pixels[k].y)) factor[k] = 0;
    });
    c.lanes &= factor > 0;
    if (!any(c.lanes)) return s;
    const BsdfEval8 f =
        eval_bsdfs(p.bsdf, c.lanes, l.to_previous, direction, Transport::importance);
    c.lanes &= ~is_black(f.f);
    // Density per area at the vertex of one camera sample per pixel area: also the importance.
    const Double8 pdf_a = to_double(camera_pdf_w(e.camera, along)) *
                          to_double(abs_dot(p.bsdf.ng, direction)) / to_double(d2);
    c.value = l.throughput * f.f *
              to_float(pdf_a * to_double(factor) / all_lanes(double(e.light_subpaths)));
    e.at(Work::weights);
    c.weight = mis::light_tracing(
        l.mis, {pdf_a, to_double(f.pdf_rev_w), all_lanes(e.count({2, strategy.t - 1}, 0, true))},
        double(e.light_subpaths) * e.share_of(strategy.edges()));
    const Vec3x8 from = leave(p, d);
    c.lanes &= ~is_nothing(c);
    let_arrive(e, c, {from, lens - from, all_lanes(1.0f)}, rays);
    return s;
}

Contribution contribution_of(const FoundLanes& f, int lane, int sample) {
    Contribution c;
    c.strategy = f.strategy(lane);
    c.value = f.value[lane];
    c.weights[0] = f.weight[lane];
    c.sample = sample;
    return c;
}

template decltype(hit_lights<power2_facts>) hit_lights<power2_facts>;
template decltype(hit_lights<path_tracer_facts>) hit_lights<path_tracer_facts>;
template FoundLanes connect_to_lights<power2_facts>(const Estimator&, const VertexLanes&,
                                                    const std::array<Float8, 4>&, RayCounts&);
template FoundLanes connect_to_lights<path_tracer_facts>(const Estimator&, const VertexLanes&,
                                                         const std::array<Float8, 4>&, RayCounts&);
template SplatLanes connect_to_camera<power2_facts>(const Estimator&, const VertexLanes&,
                                                    const std::array<Float8, 4>&, RayCounts&);

}  // namespace midway
