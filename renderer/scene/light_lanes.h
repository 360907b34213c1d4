// Next event for eight places, and the starts of eight light subpaths, at once: as
// sample_next_event() and sample_emission() answer one, with the same bits.
#pragma once

#include "math/lanes.h"
#include "scene/scene.h"

namespace midway {

// NextEventSample of the lanes that found a light.
struct NextEventLanes {
    Mask8 found{};
    Mask8 delta{}, infinite{};  // kinds of the lights
    Vec3x8 direction, target, normal, value;
    Float8 error, cos_theta, distance_squared;
    Float8 origin, leave, next_event;  // LightPdfs
};

// u: NextEventNumbers' pick, and the two of its point.
struct NextEventNumbers8 {
    Double8 pick;
    Float8 x, y;
};
NextEventLanes sample_next_events(const Scene& scene, const Mask8& wanted, const Vec3x8& reference,
                                  const NextEventNumbers8& u);

// EmissionSample of the lanes that found a light.
struct EmissionLanes {
    Mask8 found{};
    Mask8 area{}, delta{}, infinite{};  // kinds of the lights
    std::array<int, lane_count> lights{};
    Vec3x8 position, normal, direction, weight;
    Float8 error, cos_theta;
    Float8 origin, leave;  // LightPdfs
};

// u: EmissionNumbers' pick, the two of its point, and the two of its direction.
struct EmissionNumbers8 {
    Double8 pick;
    std::array<Float8, 4> u;
};
EmissionLanes sample_emissions(const Scene& scene, const Mask8& wanted, const EmissionNumbers8& u);

// next_event_ratio() of each lane's light; the edge's places and cosines, and squared lengths.
std::array<double, lane_count> next_event_ratios(const Scene& scene, const Mask8& wanted,
                                                 const std::array<int, lane_count>& lights,
                                                 const Vec3x8& reference, const Float8& cos_theta,
                                                 const Float8& distance_squared);

}  // namespace midway
