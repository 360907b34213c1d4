#include "integrator/walk_lanes.h"

#include "scene/light_lanes.h"
#include "scene/rounding.h"

namespace midway {
namespace {

void trace_rays(const Estimator& e, WalkLanes& w) {
    std::array<std::uint64_t, lane_count> coins{};
    if (e.scene->has_transparency)
        for_each_lane(w.active, [&](int k) { coins[k] = walk_coin(w.keys[k], w.index); });
    const Float8 open = all_lanes(std::numeric_limits<float>::infinity());
    e.scene->accel->closest({w.origin, w.direction, open}, w.active, {e.scene}, coins, w.hits);
    Mask8 met{};
    for_each_lane(w.active, [&](int k) { met[k] = w.hits[k].object < 0 ? 0 : -1; });
    w.surface = met;
    w.sky = w.active & ~met;
}

// Eq. (22)-(25), (34), (37), (38): sums at vertex 1.
void start_light_sums(const Estimator& e, const Vec3x8& position, const Float8& cos_in,
                      const Float8& distance2, WalkLanes& w) {
    const auto ratios =
        next_event_ratios(*e.scene, w.surface, w.lights, position, w.cos_previous, distance2);
    for_each_lane(w.surface, [&](int k) {
        const bool infinite = w.infinite_light[k], hittable = w.hittable_light[k];
        mis::LightStart l;
        l.pdf_origin = w.light_origin[k];
        l.pdf_a = w.light_leave[k] * double(cos_in[k]) / (infinite ? 1 : double(distance2[k]));
        l.g_light = infinite ? 1 : w.cos_previous[k] / double(distance2[k]);
        l.next_event_ratio = ratios[k];
        l.hittable = hittable && e.weighed[0].emitter_hit;
        const mis::State s = mis::start_light(mis::Power2<>{}, l);
        w.mis.vcm.set(k, s.vcm);
        w.mis.vc.set(k, s.vc);
    });
}

template <Facts F>
void start_sums(const Estimator& e, const Vec3x8& position, const Float8& cos_in,
                const Float8& distance2, WalkLanes& w) {
    w.mis = {all_lanes(0.0), all_lanes(0.0)};
    if constexpr (F.path_tracer) return;
    if (w.transport == Transport::importance)
        return start_light_sums(e, position, cos_in, distance2, w);
    const Double8 pdf_a = to_double(w.pdf_fwd_w) * to_double(cos_in) / to_double(distance2);
    w.mis.vcm = mis::square(all_lanes(double(e.light_subpaths)) / pdf_a);
}

template <Facts F>
void advance_sums(const Estimator& e, WalkLanes& w, const Double8& g_fwd, const Double8& g_rev) {
    const Double8 pdf_fwd_a = to_double(w.pdf_fwd_w) * g_fwd;
    if constexpr (F.path_tracer) {
        w.mis = mis::path_tracer::advance(pdf_fwd_a, w.delta);
    } else {
        const Double8 n = count_in_lanes(e, previous_strategy(w.transport, w.index),
                                         previous_is_first(w.rough, w.index));
        w.mis = mis::advance(w.mis, {pdf_fwd_a, g_rev, to_double(w.pdf_rev_w), w.delta, n});
    }
}

}  // namespace

void start_camera_walks(const Estimator& e, const PixelGroup& g, std::uint64_t pass, WalkLanes& w) {
    w.transport = Transport::radiance;
    w.active = every_lane;
    w.index = 0;
    w.rough = Mask8{};
    w.infinite_light = no_lane;
    w.delta = no_lane;
    w.throughput = all_lanes(vec3(1));
    w.roulette_reference = all_lanes(e.roulette.camera_sure);
    w.cos_previous = all_lanes(1.0f);
    w.pdf_rev_w = Float8{};
    e.at(Work::sampling);
    for (int k = 0; k < lane_count; ++k) w.keys[k] = camera_key(e, g.x(k), g.y, pass);
    const std::array<Float8, 4> u = sample_4d_pairs(w.keys, every_lane, 0).first;
    e.at(Work::shading);
    const Float8 columns = Float8{0, 1, 2, 3, 4, 5, 6, 7} * float(g.step) + float(g.x0);
    const std::array<Float8, 2> offset = sample_filters(e.filter, u[0], u[1]);
    w.origin = lens_points(e.camera, every_lane, u[2], u[3]);
    w.direction =
        camera_directions(e.camera, w.origin, columns + 0.5f + offset[0], (g.y + 0.5f) + offset[1]);
    w.pdf_fwd_w = camera_pdf_w(e.camera, dot(w.direction, all_lanes(e.camera.forward)));
    w.previous_position = w.origin;
}

void start_light_walks(const Estimator& e, const std::array<std::uint64_t, lane_count>& numbers,
                       std::uint64_t pass, WalkLanes& w) {
    w.transport = Transport::importance;
    w.index = 0;
    w.rough = Mask8{};
    w.delta = no_lane;
    w.pdf_fwd_w = w.pdf_rev_w = Float8{};
    e.at(Work::sampling);
    Mask8 wanted{};
    for (int k = 0; k < lane_count; ++k) {
        if (numbers[k] >= e.light_subpaths) continue;
        wanted[k] = -1;
        w.keys[k] = light_key(e, numbers[k], pass);
    }
    const NumberLanes u = sample_4d_pairs(w.keys, wanted, 0);
    e.at(Work::shading);
    const EmissionLanes s =
        sample_emissions(*e.scene, wanted, {fine_numbers(u.second[0], u.second[1]), u.first});
    w.active = s.found;
    w.origin =
        select(s.area, offset_origin(s.position, s.normal, s.error, s.direction), s.position);
    w.direction = s.direction;
    w.previous_position = s.position;
    w.throughput = s.weight;
    w.roulette_reference = max_component(s.weight);
    w.cos_previous = s.cos_theta;
    w.lights = s.lights;
    w.light_origin = s.origin;
    w.light_leave = s.leave;
    w.infinite_light = s.infinite;
    w.hittable_light = ~s.delta;
}

template <Facts F>
void extend(const Estimator& e, WalkLanes& w, StoredVertex& vertex) {
    e.at(Work::rays);
    trace_rays(e, w);
    ++w.index;
    // Numbers are drawn while what the hits need is still on its way (Accel::closest).
    e.at(Work::sampling);
    w.numbers = sample_4d_pairs(w.keys, w.surface, 2 + 2 * static_cast<std::uint32_t>(w.index));
    e.at(Work::shading);
    VertexLanes& v = vertex.lanes;
    v.index = w.index;
    v.rough = w.rough;
    v.throughput = w.throughput;
    surfaces_at(*e.scene, w.hits, w.surface, v.surface, vertex.store);
    const Vec3x8 back = w.previous_position - v.surface.position;
    const Float8 distance2 = length_squared(back);
    v.to_previous = back / sqrt(distance2);
    // From an infinitely far light the edge has the direction of the ray, wherever the disc lies.
    if (w.index == 1) v.to_previous = select(w.infinite_light, -w.direction, v.to_previous);
    const Float8 cos_in = abs_dot(v.surface.bsdf.ng, v.to_previous);
    // Where two surfaces touch within rounding, or one is met edge-on, there is nothing to walk.
    w.surface &= (distance2 > 0) & (cos_in > 0);
    w.active = w.surface;
    v.connectible = w.surface & connectible(v.surface.bsdf);
    e.at(Work::weights);
    // A vertex at infinity: g = 1 (eq. 37). Nothing will be weighed where a light's walk ends.
    const Float8 one = all_lanes(1.0f);
    const Float8 cos_fwd = select(w.sky, one, cos_in), d2 = select(w.sky, one, distance2);
    if (w.index == 1)
        start_sums<F>(e, v.surface.position, cos_fwd, d2, w);
    else
        advance_sums<F>(e, w, to_double(cos_fwd) / to_double(d2),
                        to_double(w.cos_previous) / to_double(d2));
    v.mis = w.mis;
    e.at(Work::shading);
}

void scatter(const Estimator& e, const VertexLanes& vertex, WalkLanes& w) {
    const SurfaceLanes& p = vertex.surface;
    const auto& u = w.numbers.first;
    const BsdfSample8 s =
        sample_bsdfs(p.bsdf, w.surface, vertex.to_previous, {u[0], u[1], u[2]}, w.transport);
    w.active = w.surface & s.drawn;
    w.throughput = w.throughput * s.weight;
    // Refraction scales radiance until the path leaves the glass again; survival ignores that.
    w.roulette_reference = w.roulette_reference * s.eta_scale;
    if (w.index >= e.roulette.start) {
        const Float8 survival = max_component(w.throughput) / w.roulette_reference;
        const Mask8 risks = survival < 1;
        w.active &= ~(risks & ~(u[3] < survival));
        w.throughput = select(risks, w.throughput / survival, w.throughput);
    }
    w.origin = offset_origin(p.position, p.bsdf.ng, p.error, s.to);
    w.direction = s.to;
    w.previous_position = p.position;
    w.pdf_fwd_w = s.pdf_fwd_w;
    w.pdf_rev_w = s.pdf_rev_w;
    w.cos_previous = abs_dot(p.bsdf.ng, s.to);
    w.delta = s.delta;
    if (w.transport == Transport::radiance)
        w.rough = (w.rough == 0) & ~s.delta ? Mask8{} + w.index : w.rough;
}

template void extend<power2_facts>(const Estimator&, WalkLanes&, StoredVertex&);
template void extend<path_tracer_facts>(const Estimator&, WalkLanes&, StoredVertex&);

}  // namespace midway
