// What light.cpp (one sample) and light_lanes.cpp (eight at once) share; nobody else includes
// it.
#pragma once

#include "math/lanes.h"
#include "scene/scene.h"

namespace midway::light_parts {

// The light that next event asks, with its probability. A parallelogram by its first triangle.
struct LightPick {
    int light = -1;
    double probability = 0;
};
std::array<LightPick, lane_count> pick_lights(const Scene& scene, const Mask8& wanted,
                                              const Vec3x8& reference, const Double8& u);

// The probability that next event picks each of eight lights at eight places; and
// next_event_ratio() of one whose probability is known.
std::array<double, lane_count> next_event_probabilities(const Scene& scene,
                                                        const std::array<int, lane_count>& lights,
                                                        const Vec3x8& reference,
                                                        const Mask8& wanted);
double ratio_of_picks(const Scene& scene, int light, const LightEdge& edge, double probability);

// Whether next event draws a lamp by solid angle.
inline bool is_near(const Scene& s, int light, const vec3& reference) {
    return (*s.lamps)[light].near_squared > length_squared(s.lights[light].position - reference);
}

// Whether a lamp emits alike from all its points.
inline bool emits_evenly(const Material& m) {
    return !m.emission_texture.used() && m.alpha_mode == AlphaMode::opaque;
}
// Radiance times coverage: a point of an alpha-tested lamp emits with probability alpha.
vec3 area_emission(const Scene& scene, int light, const vec2& b);

// sample_next_event() for a light that has been picked already.
std::optional<NextEventSample> sample_picked(const Scene& scene, const LightPick& pick,
                                             const vec3& reference, const vec2& u);

}  // namespace midway::light_parts
