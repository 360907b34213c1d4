#include "scene/light.h"

#include <algorithm>

#include "math/spherical_triangle.h"
#include "math/warp.h"
#include "scene/light_parts.h"

namespace midway {
namespace {

using namespace light_parts;

// KHR_lights_punctual: the square of a linear ramp in cos(theta) between the two cone angles.
float spot_falloff(const Light& l, float cos_theta) {
    if (cos_theta >= l.cos_inner) return 1;
    if (cos_theta <= l.cos_outer) return 0;
    return sqr((cos_theta - l.cos_outer) / (l.cos_inner - l.cos_outer));
}

// Integral of the falloff over cos(theta): the ramp gives a third of its width.
float spot_integral(const Light& l) { return (1 - l.cos_inner) + (l.cos_inner - l.cos_outer) / 3; }

float spot_pdf_w(const Light& l, float cos_theta) {
    return spot_falloff(l, cos_theta) / (2 * pi * spot_integral(l));
}

// cos(theta) in proportion to the falloff: on the ramp the cumulative is a cube.
float sample_spot_cosine(const Light& l, float u) {
    const float ramp = (l.cos_inner - l.cos_outer) / 3, all = spot_integral(l);
    if (u * all < ramp) {
        const float c =
            l.cos_outer + (l.cos_inner - l.cos_outer) * std::cbrt((u * all + 1e-9f * ramp) / ramp);
        // On a narrow ramp the sum may round to its dark end.
        return std::max(c, std::nextafter(l.cos_outer, 2.0f));
    }
    return l.cos_inner + std::min(1 - l.cos_inner, u * all - ramp);
}

float disc_pdf(const Scene& s) { return inv_pi / sqr(s.radius); }

// The disc of the scene's bounds that faces `travel`, and a point on it.
vec3 disc_point(const Scene& s, const vec3& travel, const vec2& u) {
    const Frame f = frame_from_normal(travel);
    const vec2 p = square_to_disc(u) * s.radius;
    return f.s * p.x + f.t * p.y - travel * s.radius;
}

// Next event's for lights at infinity.
double group_probability(const Scene& s, int light) {
    // In the order of the lights: a file may hold thousands of suns.
    const auto i = std::lower_bound(s.infinite_lights.begin(), s.infinite_lights.end(), light);
    return s.next_event_group.probability(static_cast<int>(i - s.infinite_lights.begin()) + 1);
}

// Of a light in the tree, of which its lamp is picked with probability `in_tree`.
double tree_probability(const Scene& s, int light, double in_tree) {
    return s.next_event_group.probability(0) * share_of_lamp(*s.lamps, light) * in_tree;
}

double next_event_probability(const Scene& s, int light, const vec3& reference) {
    if (is_infinite(s.lights[light].kind)) return group_probability(s, light);
    return tree_probability(s, light,
                            s.light_tree.probability(first_of_lamp(*s.lamps, light), reference));
}

TriangleFrom seen_from(const FlatTriangle& t, const vec3& reference) {
    const dvec3 r(reference);
    return {dvec3(t.v0) - r, dvec3(t.v1) - r, dvec3(t.v2) - r};
}

// The solid angles of a lamp's triangles; the second is zero unless they are two.
struct SolidAngles {
    TriangleFrom seen[2];
    double of[2] = {0, 0};
    double whole() const { return of[0] + of[1]; }
};
SolidAngles solid_angles(const Scene& s, int light, const vec3& reference) {
    const int first = first_of_lamp(*s.lamps, light);
    SolidAngles angles;
    for (int k = 0; k < ((*s.lamps)[first].partner == 0 ? 1 : 2); ++k) {
        angles.seen[k] = seen_from((*s.lamps)[first + k].shape, reference);
        angles.of[k] = solid_angle(angles.seen[k]);
    }
    return angles;
}

// Next event's density per area of a point on a lamp that it has picked, over the density of points
// spread evenly. Zero where the lamp is seen edge-on.
double next_event_over_even(const Scene& s, int light, const LightEdge& k) {
    if (!is_near(s, light, k.reference)) return 1;
    const double whole = solid_angles(s, light, k.reference).whole();
    const double area = s.lights[light].area / share_of_lamp(*s.lamps, light);
    return whole > 0 ? area * k.cos_theta / (double(k.distance_squared) * whole) : 0;
}

// Densities of a point on an area light with the emitted direction at cosine cos_theta, next
// event's being `next_event`.
LightPdfs area_pdfs(const Scene& s, int light, float cos_theta, double next_event) {
    const Light& l = s.lights[light];
    const float sides = l.two_sided ? 0.5f : 1.0f;
    return {static_cast<float>(l.emission_pick) / l.area,
            sides * cosine_hemisphere_pdf_w(std::abs(cos_theta)), static_cast<float>(next_event)};
}

LightPdfs sky_pdfs(const Scene& s, const vec3& direction) {
    const float pdf_w = sky_pdf_w(*s.sky, direction);
    return {static_cast<float>(s.lights[s.sky_light].emission_pick) * pdf_w, disc_pdf(s),
            static_cast<float>(group_probability(s, s.sky_light)) * pdf_w};
}

// `first`: as picked; e.light becomes the triangle.
void emit_area(const Scene& s, int first, const EmissionNumbers& u, EmissionSample& e) {
    const auto [id, b] = square_to_lamp(*s.lamps, first, u.point);
    const Light& l = s.lights[id];
    const TrianglePoint p = triangle_point((*s.lamps)[id].shape, b.x, b.y);
    e.light = id;
    vec2 ud = u.direction;
    float side = 1;
    if (l.two_sided) {
        side = ud.x < 0.5f ? 1.0f : -1.0f;
        ud.x = ud.x < 0.5f ? 2 * ud.x : 2 * ud.x - 1;
    }
    const vec3 local = square_to_cosine_hemisphere(ud);
    e.position = p.position;
    e.error = p.error;
    e.normal = p.ng * side;
    e.direction = frame_from_normal(e.normal).to_world(local);
    e.cos_theta = local.z;
    e.pdfs = area_pdfs(s, id, local.z, 0);
    e.weight = area_emission(s, id, b) * (local.z / (e.pdfs.origin * e.pdfs.leave));
}

void emit_punctual(const Scene& s, int id, const EmissionNumbers& u, EmissionSample& e) {
    const Light& l = s.lights[id];
    const auto pick = static_cast<float>(l.emission_pick);
    if (l.kind == LightKind::directional) {
        e.position = disc_point(s, l.direction, u.point);
        e.direction = l.direction;
        e.pdfs = {pick, disc_pdf(s), 0};
        e.weight = l.emission / (pick * e.pdfs.leave);
    } else if (l.kind == LightKind::point) {
        e.position = l.position;
        e.direction = square_to_sphere(u.direction);
        e.pdfs = {pick, sphere_pdf_w, 0};
        e.weight = l.emission / (pick * e.pdfs.leave);
    } else {
        const float c = sample_spot_cosine(l, u.direction.x);
        e.position = l.position;
        e.direction = frame_from_normal(l.direction).to_world(direction_from_z(c, u.direction.y));
        e.pdfs = {pick, spot_pdf_w(l, c), 0};
        e.weight = l.emission * (2 * pi * spot_integral(l) / pick);
    }
    e.normal = e.direction;
}

void emit_sky(const Scene& s, const EmissionNumbers& u, EmissionSample& e) {
    const SkySample sample = sample_sky(*s.sky, u.direction);
    e.direction = -sample.direction;
    e.position = disc_point(s, e.direction, u.point);
    e.normal = e.direction;
    e.pdfs = sky_pdfs(s, sample.direction);
    e.pdfs.next_event = 0;
    if (!(e.pdfs.origin > 0)) return;  // as in sample_next_event()
    e.weight = sky_radiance(*s.sky, sample.direction) / (e.pdfs.origin * e.pdfs.leave);
}

// Next event's point on a lamp that it has picked. Nothing where that is near and seen edge-on.
struct LampSample {
    LampPoint point;
    double solid_angle = 0;  // of the lamp; zero where it is far, and the point drawn by area
};
std::optional<LampSample> next_event_point(const Scene& s, int first, const vec3& reference,
                                           const vec2& u) {
    if (!is_near(s, first, reference)) return LampSample{square_to_lamp(*s.lamps, first, u)};
    const SolidAngles angles = solid_angles(s, first, reference);
    const double whole = angles.whole(), place = u.x * whole;
    if (!(whole > 0)) return {};
    const int k = place < angles.of[0] ? 0 : 1;
    const double inside = (k == 0 ? place : place - angles.of[0]) / angles.of[k];
    const vec2 v{std::min(static_cast<float>(inside), 1 - 0x1p-24f), u.y};
    return LampSample{{first + k, vec2(sample_solid_angle(angles.seen[k], angles.of[k], v))},
                      whole};
}

// n.light has been picked with probability `pick`; it becomes the triangle.
void next_event_area(const Scene& s, double pick, const vec3& reference, const vec2& u,
                     NextEventSample& n) {
    const std::optional<LampSample> at = next_event_point(s, n.light, reference, u);
    if (!at) return;
    n.light = at->point.light;
    const vec2& b = at->point.b;
    const Light& l = s.lights[n.light];
    const TrianglePoint p = triangle_point((*s.lamps)[n.light].shape, b.x, b.y);
    const vec3 d = p.position - reference;
    n.distance_squared = length_squared(d);
    if (!(n.distance_squared > 0)) return;
    n.direction = d / std::sqrt(n.distance_squared);
    const float c = -glm::dot(p.ng, n.direction);
    if (c == 0 || (c < 0 && !l.two_sided)) return;
    n.target = p.position;
    n.normal = p.ng;
    n.error = p.error;
    n.cos_theta = std::abs(c);
    const double even = share_of_lamp(*s.lamps, n.light) / double(l.area);
    const double by_angle = n.cos_theta / (double(n.distance_squared) * at->solid_angle);
    n.pdfs = area_pdfs(s, n.light, c, pick * (at->solid_angle > 0 ? by_angle : even));
    if (!(n.pdfs.next_event > 0)) return;
    n.value =
        area_emission(s, n.light, b) * (n.cos_theta / (n.distance_squared * n.pdfs.next_event));
}

void next_event_punctual(const Scene& s, double picked, const vec3& reference, NextEventSample& n) {
    const Light& l = s.lights[n.light];
    const auto pick = static_cast<float>(l.emission_pick);
    const auto pick_next = static_cast<float>(picked);
    if (l.kind == LightKind::directional) {
        n.direction = -l.direction;
        n.value = l.emission / pick_next;
        n.pdfs = {pick, disc_pdf(s), pick_next};
        return;
    }
    const vec3 d = l.position - reference;
    n.distance_squared = length_squared(d);
    if (!(n.distance_squared > 0)) return;
    n.direction = d / std::sqrt(n.distance_squared);
    n.target = l.position;
    const float c = -glm::dot(n.direction, l.direction);
    const bool spot = l.kind == LightKind::spot;
    n.pdfs = {pick, spot ? spot_pdf_w(l, c) : sphere_pdf_w, pick_next};
    n.value = l.emission * ((spot ? spot_falloff(l, c) : 1.0f) / (n.distance_squared * pick_next));
}

}  // namespace

namespace light_parts {

namespace {

// One of the lights at infinity, or else the place in the tree and the probability of asking it.
struct GroupPick {
    int infinite_light = -1;
    double inside = 0;
    double probability = 1;
};
GroupPick pick_group(const Scene& s, double u) {
    if (s.infinite_lights.empty()) return {-1, u, 1};
    const int group = find_interval(s.next_event_group, u);
    const double p = s.next_event_group.probability(group);
    if (group > 0) return {s.infinite_lights[static_cast<size_t>(group) - 1], 0, p};
    return {-1, std::clamp((u - s.next_event_group.cdf[0]) / p, 0.0, 1 - 0x1p-53), p};
}

LightPick pick_light(const Scene& s, const vec3& reference, double u) {
    const GroupPick g = pick_group(s, u);
    if (g.infinite_light >= 0) return {g.infinite_light, g.probability};
    LightPick p;
    p.light = s.light_tree.sample(reference, g.inside, p.probability);
    p.probability *= g.probability;
    return p;
}

}  // namespace

std::array<LightPick, lane_count> pick_lights(const Scene& s, const Mask8& wanted,
                                              const Vec3x8& reference, const Double8& u) {
    std::array<LightPick, lane_count> picks;
    Mask8 by_tree{};
    Double8 inside{};
    for_each_lane(wanted, [&](int k) {
        const GroupPick g = pick_group(s, u[k]);
        picks[k] = {g.infinite_light, g.probability};
        inside.set(k, g.inside);
        if (g.infinite_light < 0) by_tree[k] = -1;
    });
    LightTree::Picks of_tree;
    s.light_tree.sample(reference, inside, by_tree, of_tree);
    for_each_lane(by_tree, [&](int k) {
        picks[k].light = of_tree.light[k];
        picks[k].probability *= of_tree.probability[k];
        // What is read of a lamp next.
        __builtin_prefetch(&s.lights[of_tree.light[k]]);
        if (static_cast<size_t>(of_tree.light[k]) < s.lamps->size())
            __builtin_prefetch(&(*s.lamps)[of_tree.light[k]]);
    });
    return picks;
}

double ratio_of_picks(const Scene& s, int light, const LightEdge& k, double probability) {
    const Light& l = s.lights[light];
    const double picks = probability / l.emission_pick;
    return l.kind == LightKind::area ? picks * next_event_over_even(s, light, k) : picks;
}

std::array<double, lane_count> next_event_probabilities(const Scene& s,
                                                        const std::array<int, lane_count>& lights,
                                                        const Vec3x8& reference,
                                                        const Mask8& wanted) {
    std::array<double, lane_count> p{};
    std::array<int, lane_count> lamps{};
    Mask8 by_tree{};
    for_each_lane(wanted, [&](int k) {
        if (is_infinite(s.lights[lights[k]].kind)) {
            p[k] = group_probability(s, lights[k]);
            return;
        }
        lamps[k] = first_of_lamp(*s.lamps, lights[k]);
        by_tree[k] = -1;
    });
    const auto in_tree = s.light_tree.probabilities(lamps, reference, by_tree);
    for_each_lane(by_tree, [&](int k) { p[k] = tree_probability(s, lights[k], in_tree[k]); });
    return p;
}

vec3 area_emission(const Scene& s, int light, const vec2& b) {
    const Material& m = s.materials[(*s.lamps)[light].material];
    if (emits_evenly(m)) return m.emission;
    const TriangleHit hit = hit_on_lamp((*s.lamps)[light], s.lights[light], b);
    const ShadingPoint p = surface_point(s.geometry->objects[hit.object], hit).shading;
    return material_emission(m, s.textures, p) * material_alpha(m, s.textures, p);
}

std::optional<NextEventSample> sample_picked(const Scene& s, const LightPick& pick,
                                             const vec3& reference, const vec2& u) {
    std::optional<NextEventSample> found;
    NextEventSample& n = found.emplace();
    n.light = pick.light;
    const LightKind kind = s.lights[n.light].kind;
    if (kind == LightKind::area) {
        next_event_area(s, pick.probability, reference, u, n);
    } else if (kind == LightKind::sky) {
        n.direction = sample_sky(*s.sky, u).direction;
        n.pdfs = sky_pdfs(s, n.direction);
        // Rounded, the direction may lie in the next cell, which may be black and have no density.
        if (n.pdfs.next_event > 0) n.value = sky_radiance(*s.sky, n.direction) / n.pdfs.next_event;
    } else {
        next_event_punctual(s, pick.probability, reference, n);
    }
    if (is_black(n.value)) found.reset();
    return found;
}

}  // namespace light_parts

std::optional<EmissionSample> sample_emission(const Scene& s, const EmissionNumbers& u) {
    std::optional<EmissionSample> found;
    if (!(s.emission_pick.total > 0)) return found;
    const int id = find_interval(s.emission_pick, u.pick);
    const LightKind kind = s.lights[id].kind;
    EmissionSample& e = found.emplace();
    e.light = id;
    if (kind == LightKind::area) {
        emit_area(s, id, u, e);
    } else if (kind == LightKind::sky) {
        emit_sky(s, u, e);
    } else {
        emit_punctual(s, id, u, e);
    }
    if (is_black(e.weight)) found.reset();
    return found;
}

std::optional<NextEventSample> sample_next_event(const Scene& s, const vec3& reference,
                                                 const NextEventNumbers& u) {
    if (!(s.next_event_group.total > 0)) return {};
    return sample_picked(s, pick_light(s, reference, u.pick), reference, u.point);
}

double next_event_ratio(const Scene& s, int light, const LightEdge& k) {
    const double picks = next_event_probability(s, light, k.reference);
    return light_parts::ratio_of_picks(s, light, k, picks);
}

std::optional<EmitterHit> emitter_hit(const Scene& s, const SurfacePoint& p, const vec3& towards,
                                      const vec3& reference) {
    const int first = s.first_light[p.hit.object];
    if (first < 0) return {};
    const int id = first + p.hit.triangle;
    const Light& l = s.lights[id];
    const float c = glm::dot(p.shading.ng, towards);
    if (c == 0 || (c < 0 && !l.two_sided) || !(l.power > 0)) return {};
    // Coverage has been decided by the coin that let the ray hit.
    const vec3 radiance = material_emission(material_at(s, p), s.textures, p.shading);
    if (is_black(radiance)) return {};
    const LightEdge edge{reference, std::abs(c), length_squared(p.position - reference)};
    const double next_event =
        next_event_probability(s, id, reference) * next_event_over_even(s, id, edge) / l.area;
    return EmitterHit{radiance, area_pdfs(s, id, c, next_event)};
}

std::optional<EmitterHit> sky_hit(const Scene& s, const vec3& direction) {
    if (s.sky_light < 0) return {};
    const vec3 radiance = sky_radiance(*s.sky, direction);
    if (is_black(radiance)) return {};
    return EmitterHit{radiance, sky_pdfs(s, direction)};
}

}  // namespace midway
