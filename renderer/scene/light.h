// The five kinds of light of the seed document ("Special handling for light"), as seen from both
// ends of a path: emission (light subpaths), next event (a point chosen for a surface) and hits.
//
// Every interface reports the same three densities, so that any strategy's pdf can be formed
// (eq. 24-38; README, "The method"). For a finite light the *origin* is the point on the light
// and the *leave* density is that of the direction; for an infinite light the origin is the
// direction (eq. 35) and the leave density that of the place on the bounding disc (eq. 38):
//                        finite                          infinite
//   pdf_origin           per area, times the pick        per solid angle, times the pick
//   pdf_leave            per solid angle                 per area of the disc
//   pdf_next_event       as pdf_origin, but with the probability that next event picks the light
//                        with, which depends on the place that asks (light_tree.h); a lamp
//                        that is near is drawn by its solid angle (math/spherical_triangle.h)
// A Dirac factor (a point's position, a sun's direction) is left out: the pick alone remains.
#pragma once

#include <optional>

#include "math/distribution.h"
#include "scene/geometry.h"
#include "scene/sky.h"

namespace midway {

enum class LightKind : std::uint8_t { point, spot, directional, area, sky };

struct Light {
    LightKind kind = LightKind::point;
    vec3 position{0};   // point, spot; area: its centroid, of both triangles of a parallelogram
    vec3 direction{0};  // spot, directional: where the light travels, unit
    vec3 emission{0};   // intensity (scene units), irradiance, or unused for area and sky
    float cos_inner = 1, cos_outer = 0;  // spot
    int object = -1, triangle = -1;      // area
    float area = 0;
    bool two_sided = false;
    bool reaches = true;       // false: it sends no light to any surface (reach.h)
    double power = 0;          // mean of RGB
    double emission_pick = 0;  // probability that a light subpath begins here
};

inline bool is_infinite(LightKind k) { return k == LightKind::directional || k == LightKind::sky; }
// A delta light cannot be hit (eq. 34).
inline bool is_delta(LightKind k) { return k != LightKind::area && k != LightKind::sky; }

struct LightPdfs {
    float origin = 0, leave = 0, next_event = 0;
};

// Start of a light subpath.
struct EmissionSample {
    int light = -1;
    vec3 position{0};  // origin of the ray
    float error = 0;   // of the position, finite lights with a surface
    vec3 normal{0};    // of the emitting side; the direction itself for lights without a surface
    vec3 direction{0};
    vec3 weight{0};       // Le |cos| / (pdf_origin pdf_leave)
    LightPdfs pdfs;       // next_event is left zero: nobody asks yet
    float cos_theta = 1;  // of the direction at the origin; 1 without a surface
};

// A light chosen for a surface point.
struct NextEventSample {
    int light = -1;
    vec3 direction{0};  // towards the light, unit
    vec3 target{0};     // end of the shadow ray, on the light; unused for infinite lights
    vec3 normal{0};     // at the target, zero without a surface
    float error = 0;    // of the target
    vec3 value{0};      // radiance, or intensity / d^2, or irradiance, divided by its density
    LightPdfs pdfs;
    float cos_theta = 1;         // at the light
    float distance_squared = 1;  // 1 for infinite lights
};

// From a point on a light to the place that asks next event for it.
struct LightEdge {
    vec3 reference{0};
    float cos_theta = 1;  // at the light, not negative
    float distance_squared = 1;
};

// A light that a ray hit by chance.
struct EmitterHit {
    vec3 radiance{0};
    LightPdfs pdfs;
};

}  // namespace midway
