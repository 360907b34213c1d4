#include "integrator/estimator_lanes.h"

#include "scene/light_lanes.h"
#include "scene/rounding.h"

namespace midway {
namespace {

Vec3x8 leave(const SurfaceLanes& p, const Vec3x8& towards) {
    return offset_origin(p.position, p.bsdf.ng, p.error, towards);
}
Vec3x8 arrive_at(const SurfaceLanes& p, const Vec3x8& from) {
    return offset_end(p.position, p.bsdf.ng, p.error, from);
}

// Traces the rays of what would carry something; lanes that are blocked are no longer found.
void let_pass(const Estimator& e, FoundLanes& c, const RayLanes& edges, RayCounts& rays) {
    c.lanes &= ~is_black(c.value) & not_zero(c.weight);
    rays.count_shadow(c.strategy, static_cast<unsigned>(std::popcount(bits(c.lanes))));
    e.at(Work::rays);
    const Float8 part = e.scene->accel->transmittance(edges, c.lanes, {e.scene});
    e.at(Work::other);
    c.value = c.value * part;
    c.lanes &= part > 0;
}

// may_scatter() of bsdf.h.
Mask8 may_scatter(const BsdfLanes& b, const Vec3x8& from, const Vec3x8& to) {
    Mask8 m = dot(from, b.ng) * dot(to, b.ng) > 0;
    for_each_lane(b.others, [&](int k) {
        if (b.other[k]->has_glass()) m[k] = -1;
    });
    return m;
}

// n of the strategies that move the connecting edge one step towards the camera, or the light.
double count_towards_camera(const Estimator& e, const Strategy& k) {
    return e.count({k.s - 1, k.t + 1}, 0);
}
double count_towards_light(const Estimator& e, const Strategy& k) {
    return e.count({k.s + 1, k.t - 1}, 0);
}

BsdfLanes rotated(const BsdfLanes& b, int shift) {
    const Mask8 from = rotation(shift);
    BsdfLanes r;
    r.ng = rotate(b.ng, from);
    r.normal = rotate(b.normal, from);
    r.diffuse = rotate(b.diffuse, from);
    r.others = rotate(b.others, from);
    for (int k = 0; k < lane_count; ++k) r.other[k] = b.other[(k + shift) % lane_count];
    return r;
}

// Lane k has what lane k + shift had.
VertexLanes rotated(const VertexLanes& v, int shift) {
    const Mask8 from = rotation(shift);
    VertexLanes r;
    r.surface.position = rotate(v.surface.position, from);
    r.surface.error = rotate(v.surface.error, from);
    r.surface.bsdf = rotated(v.surface.bsdf, shift);
    r.to_previous = rotate(v.to_previous, from);
    r.throughput = rotate(v.throughput, from);
    r.mis = {rotate(v.mis.vcm, from), rotate(v.mis.vc, from)};
    r.index = v.index;
    r.connectible = rotate(v.connectible, from);
    return r;
}

}  // namespace

template <Facts F>
FoundLanes hit_lights(const Estimator& e, const WalkLanes& w, const VertexLanes& v) {
    FoundLanes found{.strategy = {w.index + 1, 0}};
    if (!e.families.emitter_hit && !(found.strategy.s == 2 && e.direct_lamps)) return found;
    const auto add = [&](int k, const std::optional<EmitterHit>& hit) {
        if (!hit) return;
        const mis::State sums{w.mis.vcm[k], w.mis.vc[k]};
        const Contribution c = weigh_hit<F>(e, *hit, found.strategy, w.throughput[k], &sums);
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
    FoundLanes c{.strategy = {v.index + 1, 1}};
    const NextEventLanes n = sample_next_events(*e.scene, v.connectible, p.position,
                                                {fine_numbers(u[0], u[3]), u[1], u[2]});
    if (!any(n.found)) return c;
    const BsdfEval8 f =
        eval_bsdfs(p.bsdf, n.found, v.to_previous, n.direction, Transport::radiance);
    c.lanes = n.found & ~is_black(f.f);
    const Float8 cos = abs_dot(p.bsdf.ng, n.direction);
    const Double8 cos_v = to_double(cos), distance2 = to_double(n.distance_squared);
    const int edges = c.strategy.edges(), count = e.next_events(edges);
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
        c.weight = mis::next_event(
            v.mis, {pdf_a, to_double(f.pdf_rev_w), count_towards_camera(e, c.strategy)}, pdfs);
    }
    const Vec3x8 from = leave(p, n.direction);
    const Vec3x8 to = offset_end(n.target, n.normal, n.error, p.position);
    const Float8 open = all_lanes(std::numeric_limits<float>::infinity());
    let_pass(e, c,
             {from, select(n.infinite, n.direction, to - from),
              select(n.infinite, open, all_lanes(1.0f))},
             rays);
    return c;
}

template <Facts F>
FoundLanes connect(const Estimator& e, const VertexLanes& v, const VertexLanes& light, int shift,
                   RayCounts& rays) {
    e.at(Work::shading);
    FoundLanes c{.strategy = {v.index + 1, light.index + 1}};
    if (!any(v.connectible & rotate(light.connectible, rotation(shift)))) return c;
    const VertexLanes l = rotated(light, shift);
    const SurfaceLanes &p = v.surface, &q = l.surface;
    const Vec3x8 d = q.position - p.position;
    const Float8 d2 = length_squared(d);
    const Vec3x8 direction = d / sqrt(d2);
    c.lanes = v.connectible & l.connectible & (d2 > 0) &
              may_scatter(p.bsdf, v.to_previous, direction) &
              may_scatter(q.bsdf, l.to_previous, -direction);
    if (!any(c.lanes)) return c;
    const BsdfEval8 fv = eval_bsdfs(p.bsdf, c.lanes, v.to_previous, direction, Transport::radiance);
    c.lanes &= ~is_black(fv.f);
    const BsdfEval8 fl =
        eval_bsdfs(q.bsdf, c.lanes, l.to_previous, -direction, Transport::importance);
    c.lanes &= ~is_black(fl.f);
    const Double8 distance2 = to_double(d2);
    const Double8 g_v = to_double(abs_dot(p.bsdf.ng, direction)) / distance2;
    const Double8 g_l = to_double(abs_dot(q.bsdf.ng, direction)) / distance2;
    c.value = v.throughput * fv.f * fl.f * l.throughput *
              to_float(g_v * g_l * distance2 / all_lanes(e.connection_share));
    e.at(Work::weights);
    const mis::Side8 camera{to_double(fl.pdf_fwd_w) * g_v, to_double(fv.pdf_rev_w),
                            count_towards_camera(e, c.strategy)};
    const mis::Side8 side{to_double(fv.pdf_fwd_w) * g_l, to_double(fl.pdf_rev_w),
                          count_towards_light(e, c.strategy)};
    c.weight = mis::connection(v.mis, camera, l.mis, side, e.connection_share);
    const Vec3x8 from = leave(p, d), to = arrive_at(q, p.position);
    let_pass(e, c, {from, to - from, all_lanes(1.0f)}, rays);
    return c;
}

template <Facts F>
SplatLanes connect_to_camera(const Estimator& e, const VertexLanes& l,
                             const std::array<Float8, 4>& u, RayCounts& rays) {
    e.at(Work::shading);
    SplatLanes s;
    FoundLanes& c = s.found;
    c.strategy = {1, l.index + 1};
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
        l.mis, {pdf_a, to_double(f.pdf_rev_w), count_towards_light(e, c.strategy)},
        double(e.light_subpaths) * e.share_of(c.strategy.edges()));
    const Vec3x8 from = leave(p, d);
    let_pass(e, c, {from, lens - from, all_lanes(1.0f)}, rays);
    return s;
}

Contribution contribution_of(const FoundLanes& f, int lane, int sample) {
    Contribution c;
    c.strategy = f.strategy;
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
template FoundLanes connect<power2_facts>(const Estimator&, const VertexLanes&, const VertexLanes&,
                                          int, RayCounts&);
template SplatLanes connect_to_camera<power2_facts>(const Estimator&, const VertexLanes&,
                                                    const std::array<Float8, 4>&, RayCounts&);

}  // namespace midway
