#include "scene/next_event_lanes.h"

#include "scene/light_parts.h"
#include "scene/rounding.h"

namespace midway {
namespace {

using namespace light_parts;

// Points on lamps that have been picked and are drawn by area.
struct LampLanes {
    Vec3x8 v0, v1, v2, ng, emission;
    Float8 extent, b1, b2, area, emission_pick;
    Double8 next_event;  // density per area
    Mask8 two_sided{};
};

void gather_lamp(const Scene& s, const LightPick& pick, const vec2& u, int lane, LampLanes& g) {
    const LampPoint p = square_to_lamp(*s.lamps, pick.light, u);
    const LampTriangle& lamp = (*s.lamps)[p.light];
    const Light& l = s.lights[p.light];
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
    g.next_event.set(lane, pick.probability * (share_of_lamp(*s.lamps, p.light) / double(l.area)));
    g.two_sided[lane] = l.two_sided ? -1 : 0;
}

// A lamp that is the only light and emits evenly: whatever is picked is known beforehand.
struct OnlyLamp {
    int light = -1;  // the first of its triangles
    const LampTriangle* triangles = nullptr;
};
std::optional<OnlyLamp> only_lamp(const Scene& s) {
    const int light = s.infinite_lights.empty() ? s.light_tree.only() : -1;
    if (light < 0 || s.lights[light].kind != LightKind::area) return {};
    const LampTriangle* lamp = &(*s.lamps)[light];
    if (!emits_evenly(s.materials[lamp->material])) return {};
    return OnlyLamp{light, lamp};
}

// The same of gather_lamp(), for all lanes, from one or from either of its two triangles.
void spread_lamp(const Scene& s, const OnlyLamp& only, const NextEventNumbers8& u, LampLanes& g) {
    const bool two = only.triangles->partner != 0;
    const Mask8 second = two ? u.x + u.y >= 1.0f : no_lane;
    const auto either = [&](const auto& of_triangle) {
        const auto first = all_lanes(of_triangle(0));
        return two ? select(second, all_lanes(of_triangle(1)), first) : first;
    };
    const auto shape = [&](int i) -> const FlatTriangle& { return only.triangles[i].shape; };
    const Light* lights = &s.lights[only.light];
    g.v0 = either([&](int i) { return shape(i).v0; });
    g.v1 = either([&](int i) { return shape(i).v1; });
    g.v2 = either([&](int i) { return shape(i).v2; });
    g.ng = either([&](int i) { return shape(i).ng; });
    g.extent = either([&](int i) { return shape(i).extent; });
    g.area = either([&](int i) { return lights[i].area; });
    g.emission_pick = either([&](int i) { return static_cast<float>(lights[i].emission_pick); });
    const double share = share_of_lamp(*s.lamps, only.light);
    g.next_event = either([&](int i) { return share / double(lights[i].area); });
    g.emission = all_lanes(s.materials[only.triangles->material].emission);
    g.two_sided = lights->two_sided ? every_lane : no_lane;
    if (two) {
        g.b1 = select(second, 1.0f - u.x, u.x);
        g.b2 = select(second, 1.0f - u.y, u.y);
    } else {
        const TrianglePlace<Float8> b = square_to_triangle(u.x, u.y);
        g.b1 = b.b1;
        g.b2 = b.b2;
    }
}

// As next_event_area() of light.cpp, far from the lamp.
void sample_lamps(const LampLanes& g, const Mask8& lanes, const Vec3x8& reference,
                  NextEventLanes& n) {
    n.target = g.v0 * (1.0f - g.b1 - g.b2) + g.v1 * g.b1 + g.v2 * g.b2;
    n.error = rounding_error(max_component(abs(n.target)) + g.extent);
    n.normal = g.ng;
    const Vec3x8 d = n.target - reference;
    n.distance_squared = length_squared(d);
    n.direction = d / sqrt(n.distance_squared);
    const Float8 c = -dot(g.ng, n.direction);
    n.cos_theta = abs(c);
    n.origin = g.emission_pick / g.area;
    const Float8 sides = select(g.two_sided, all_lanes(0.5f), all_lanes(1.0f));
    n.leave = sides * (n.cos_theta * inv_pi);
    n.next_event = to_float(g.next_event);
    n.value = g.emission * (n.cos_theta / (n.distance_squared * n.next_event));
    n.found = lanes & (n.distance_squared > 0) & (c != 0) & ((c > 0) | g.two_sided) &
              (n.next_event > 0) & ~is_black(n.value);
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

}  // namespace

NextEventLanes sample_next_events(const Scene& s, const Mask8& wanted, const Vec3x8& reference,
                                  const NextEventNumbers8& u) {
    NextEventLanes n{};
    if (!(s.next_event_group.total > 0)) return n;
    Mask8 others{};
    std::array<LightPick, lane_count> picks;
    LampLanes lamps{};
    if (const std::optional<OnlyLamp> only = only_lamp(s)) {
        const Vec3x8 apart = all_lanes(s.lights[only->light].position) - reference;
        others = wanted & (length_squared(apart) < only->triangles->near_squared);
        picks.fill({only->light, 1});
        spread_lamp(s, *only, u, lamps);
    } else {
        for_each_lane(wanted, [&](int k) {
            const vec3 at = reference[k];
            picks[k] = pick_light(s, at, u.pick[k]);
            const bool area = s.lights[picks[k].light].kind == LightKind::area;
            if (area && !is_near(s, picks[k].light, at))
                gather_lamp(s, picks[k], {u.x[k], u.y[k]}, k, lamps);
            else
                others[k] = -1;
        });
    }
    if (any(wanted & ~others)) sample_lamps(lamps, wanted & ~others, reference, n);
    for_each_lane(others, [&](int k) {
        const auto one = sample_picked(s, picks[k], reference[k], {u.x[k], u.y[k]});
        if (one) set_lane(s, *one, k, n);
    });
    return n;
}

}  // namespace midway
