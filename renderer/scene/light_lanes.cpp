#include "scene/light_lanes.h"

#include "math/warp.h"
#include "scene/light_parts.h"
#include "scene/rounding.h"

namespace midway {
namespace {

using namespace light_parts;

// Points on lamps that have been picked and are drawn by area.
struct LampLanes {
    std::array<int, lane_count> lights{};  // triangles
    Vec3x8 v0, v1, v2, ng, emission;
    Float8 extent, b1, b2, area, emission_pick;
    Double8 even;  // density per area of points on a lamp that has been picked
    Mask8 two_sided{};

    Vec3x8 position() const { return v0 * (1.0f - b1 - b2) + v1 * b1 + v2 * b2; }
    Float8 error(const Vec3x8& position) const {
        return rounding_error(max_component(abs(position)) + extent);
    }
    // LightPdfs.
    Float8 origin() const { return emission_pick / area; }
    Float8 leave(const Float8& cosine) const {
        return select(two_sided, all_lanes(0.5f), all_lanes(1.0f)) * (cosine * inv_pi);
    }
};

// One lane: of the lamp that begins with triangle `first`.
void gather_lamp(const Scene& s, int first, const vec2& u, int lane, LampLanes& g) {
    const LampPoint p = square_to_lamp(*s.lamps, first, u);
    const LampTriangle& lamp = (*s.lamps)[p.light];
    const Light& l = s.lights[p.light];
    g.lights[lane] = p.light;
    g.v0.set(lane, lamp.shape.v0);
    g.v1.set(lane, lamp.shape.v1);
    g.v2.set(lane, lamp.shape.v2);
    g.ng.set(lane, lamp.shape.ng);
    g.emission.set(lane, area_emission(s, p.light, p.b));
    g.extent[lane] = lamp.shape.extent;
    g.b1[lane] = p.b.x;
    g.b2[lane] = p.b.y;
    g.area[lane] = l.area;
    g.emission_pick[lane] = static_cast<float>(l.emission_pick);
    g.even.set(lane, share_of_lamp(*s.lamps, p.light) / double(l.area));
    g.two_sided[lane] = l.two_sided ? -1 : 0;
}

// A lamp that is the only light and emits evenly: whatever is picked is known beforehand. Its first
// triangle; -1: there is none.
int only_lamp(const Scene& s) {
    const int light = s.infinite_lights.empty() ? s.light_tree.only() : -1;
    const bool area = light >= 0 && s.lights[light].kind == LightKind::area;
    return area && emits_evenly(s.materials[(*s.lamps)[light].material]) ? light : -1;
}

// gather_lamp() for all lanes, of one lamp: from one or from either of its two triangles.
void spread_lamp(const Scene& s, int first, const Float8& x, const Float8& y, LampLanes& g) {
    const LampTriangle* lamp = &(*s.lamps)[first];
    const Light* light = &s.lights[first];
    const bool two = lamp->partner != 0;
    const Mask8 second = two ? x + y >= 1.0f : no_lane;
    const auto either = [&](const auto& of_triangle) {
        const auto one = all_lanes(of_triangle(0));
        return two ? select(second, all_lanes(of_triangle(1)), one) : one;
    };
    for (int k = 0; k < lane_count; ++k) g.lights[k] = first - second[k];
    g.v0 = either([&](int i) { return lamp[i].shape.v0; });
    g.v1 = either([&](int i) { return lamp[i].shape.v1; });
    g.v2 = either([&](int i) { return lamp[i].shape.v2; });
    g.ng = either([&](int i) { return lamp[i].shape.ng; });
    g.extent = either([&](int i) { return lamp[i].shape.extent; });
    g.area = either([&](int i) { return light[i].area; });
    g.emission_pick = either([&](int i) { return static_cast<float>(light[i].emission_pick); });
    const double share = share_of_lamp(*s.lamps, first);
    g.even = either([&](int i) { return share / double(light[i].area); });
    g.emission = all_lanes(s.materials[lamp->material].emission);
    g.two_sided = light->two_sided ? every_lane : no_lane;
    if (two) {
        g.b1 = select(second, 1.0f - x, x);
        g.b2 = select(second, 1.0f - y, y);
    } else {
        const TrianglePlace<Float8> b = square_to_triangle(x, y);
        g.b1 = b.b1;
        g.b2 = b.b2;
    }
}

// As next_event_area() of light.cpp, far from the lamps, which were picked with probability `pick`.
void sample_lamps(const LampLanes& g, const Mask8& lanes, const Double8& pick,
                  const Vec3x8& reference, NextEventLanes& n) {
    n.target = g.position();
    n.error = g.error(n.target);
    n.normal = g.ng;
    const Vec3x8 d = n.target - reference;
    n.distance_squared = length_squared(d);
    n.direction = d / sqrt(n.distance_squared);
    const Float8 c = -dot(g.ng, n.direction);
    n.cos_theta = abs(c);
    n.origin = g.origin();
    n.leave = g.leave(n.cos_theta);
    n.next_event = to_float(pick * g.even);
    n.value = g.emission * (n.cos_theta / (n.distance_squared * n.next_event));
    n.found = lanes & (n.distance_squared > 0) & (c != 0) & ((c > 0) | g.two_sided) &
              (n.next_event > 0) & ~is_black(n.value);
}

// As emit_area() of light.cpp.
void emit_from_lamps(const LampLanes& g, const Mask8& lanes, Float8 x, const Float8& y,
                     EmissionLanes& e) {
    const Mask8 front = x < 0.5f;
    x = select(g.two_sided, select(front, 2.0f * x, 2.0f * x - 1.0f), x);
    const Float8 side = select(front | ~g.two_sided, all_lanes(1.0f), all_lanes(-1.0f));
    const Vec3x8 local = square_to_cosine_hemisphere(x, y);
    e.area = lanes;
    e.lights = g.lights;
    e.position = g.position();
    e.error = g.error(e.position);
    e.normal = g.ng * side;
    e.direction = frames_from_normals(e.normal).to_world(local);
    e.cos_theta = local.z;
    e.origin = g.origin();
    e.leave = g.leave(local.z);
    e.weight = g.emission * (local.z / (e.origin * e.leave));
    e.found = lanes & ~is_black(e.weight);
}

void set_lane(const Scene& s, const NextEventSample& one, int lane, NextEventLanes& n) {
    const LightKind kind = s.lights[one.light].kind;
    n.found[lane] = -1;
    n.delta[lane] = is_delta(kind) ? -1 : 0;
    n.infinite[lane] = is_infinite(kind) ? -1 : 0;
    n.direction.set(lane, one.direction);
    n.target.set(lane, one.target);
    n.normal.set(lane, one.normal);
    n.value.set(lane, one.value);
    n.error[lane] = one.error;
    n.cos_theta[lane] = one.cos_theta;
    n.distance_squared[lane] = one.distance_squared;
    n.origin[lane] = one.pdfs.origin;
    n.leave[lane] = one.pdfs.leave;
    n.next_event[lane] = one.pdfs.next_event;
}

void set_lane(const Scene& s, const EmissionSample& one, int lane, EmissionLanes& e) {
    const LightKind kind = s.lights[one.light].kind;
    e.found[lane] = -1;
    e.area[lane] = kind == LightKind::area ? -1 : 0;
    e.delta[lane] = is_delta(kind) ? -1 : 0;
    e.infinite[lane] = is_infinite(kind) ? -1 : 0;
    e.lights[lane] = one.light;
    e.position.set(lane, one.position);
    e.normal.set(lane, one.normal);
    e.direction.set(lane, one.direction);
    e.weight.set(lane, one.weight);
    e.error[lane] = one.error;
    e.cos_theta[lane] = one.cos_theta;
    e.origin[lane] = one.pdfs.origin;
    e.leave[lane] = one.pdfs.leave;
}

}  // namespace

NextEventLanes sample_next_events(const Scene& s, const Mask8& wanted, const Vec3x8& reference,
                                  const NextEventNumbers8& u) {
    NextEventLanes n{};
    if (!(s.next_event_group.total > 0)) return n;
    Mask8 others{};
    std::array<LightPick, lane_count> picks;
    Double8 probability = all_lanes(1.0);
    LampLanes lamps{};
    if (const int only = only_lamp(s); only >= 0) {
        const Vec3x8 apart = all_lanes(s.lights[only].position) - reference;
        others = wanted & (length_squared(apart) < (*s.lamps)[only].near_squared);
        picks.fill({only, 1});
        spread_lamp(s, only, u.x, u.y, lamps);
    } else {
        picks = pick_lights(s, wanted, reference, u.pick);
        for_each_lane(wanted, [&](int k) {
            probability.set(k, picks[k].probability);
            const bool area = s.lights[picks[k].light].kind == LightKind::area;
            if (area && !is_near(s, picks[k].light, reference[k]))
                gather_lamp(s, picks[k].light, {u.x[k], u.y[k]}, k, lamps);
            else
                others[k] = -1;
        });
    }
    if (any(wanted & ~others)) sample_lamps(lamps, wanted & ~others, probability, reference, n);
    for_each_lane(others, [&](int k) {
        const auto one = sample_picked(s, picks[k], reference[k], {u.x[k], u.y[k]});
        if (one) set_lane(s, *one, k, n);
    });
    return n;
}

EmissionLanes sample_emissions(const Scene& s, const Mask8& wanted, const EmissionNumbers8& n) {
    EmissionLanes e{};
    if (!(s.emission_pick.total > 0)) return e;
    const auto& u = n.u;
    Mask8 others{};
    LampLanes lamps{};
    if (const int only = only_lamp(s); only >= 0 && s.emission_pick.probability(only) == 1) {
        spread_lamp(s, only, u[0], u[1], lamps);
    } else {
        for_each_lane(wanted, [&](int k) {
            const int light = find_interval(s.emission_pick, n.pick[k]);
            if (s.lights[light].kind == LightKind::area)
                gather_lamp(s, light, {u[0][k], u[1][k]}, k, lamps);
            else
                others[k] = -1;
        });
    }
    if (any(wanted & ~others)) emit_from_lamps(lamps, wanted & ~others, u[2], u[3], e);
    for_each_lane(others, [&](int k) {
        const auto one = sample_emission(s, {n.pick[k], {u[0][k], u[1][k]}, {u[2][k], u[3][k]}});
        if (one) set_lane(s, *one, k, e);
    });
    return e;
}

std::array<double, lane_count> next_event_ratios(const Scene& s, const Mask8& wanted,
                                                 const std::array<int, lane_count>& lights,
                                                 const Vec3x8& reference, const Float8& cos_theta,
                                                 const Float8& distance_squared) {
    auto ratios = next_event_probabilities(s, lights, reference, wanted);
    for_each_lane(wanted, [&](int k) {
        const LightEdge edge{reference[k], cos_theta[k], distance_squared[k]};
        ratios[k] = ratio_of_picks(s, lights[k], edge, ratios[k]);
    });
    return ratios;
}

}  // namespace midway
