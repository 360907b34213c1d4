// The triangles of area lights, as sampling reads them. Two successive ones of an object that form
// a parallelogram, as a rectangular lamp is cut into triangles by whoever exports it, are drawn as
// one: a single pick, then a point of the whole from a point of the square. What is even in the
// square stays so over all of the lamp, and among one rectangle there is nothing to choose. A light
// is a triangle all the same: its density is half that of the pick, spread over its own area.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "math/warp.h"
#include "scene/geometry.h"
#include "scene/light.h"

namespace midway {

// In one line of the cache.
struct alignas(64) LampTriangle {
    FlatTriangle shape;  // of a parallelogram: from the vertex that its partner does not have
    int material = 0;
    // Next event draws a lamp by its solid angle for places nearer to Light::position than the root
    // of this: twice the side of a square as large as the triangle. From further off that was
    // measured to take more time than it saves: at a twentieth for this quarter (of area over
    // squared distance), a sixth more for an error 4 % lower in a Cornell box.
    float near_squared = 0;
    std::int8_t partner = 0;  // number of the other one of a parallelogram less its own; 0: none
    std::uint8_t turned = 0;  // which vertex of the object's triangle is the shape's first
};
using LampTriangles = std::shared_ptr<const std::vector<LampTriangle>>;

// Of the area lights, which come first among `lights`, in the order of their triangles.
LampTriangles make_lamps(const Geometry& geometry, const std::vector<Light>& lights);

// What picks stand for: the triangle itself, or the first one of its parallelogram.
inline int first_of_lamp(const std::vector<LampTriangle>& lamps, int light) {
    const bool area = static_cast<size_t>(light) < lamps.size();
    return area && lamps[light].partner < 0 ? light - 1 : light;
}
// The share of such a pick that falls to one of its triangles.
inline double share_of_lamp(const std::vector<LampTriangle>& lamps, int light) {
    const bool area = static_cast<size_t>(light) < lamps.size();
    return area && lamps[light].partner != 0 ? 0.5 : 1.0;
}

// A point of a lamp that has been picked: one of its triangles, and the weights of that shape's
// vertices 1 and 2. Even over each triangle, half of the square for each of a parallelogram's.
struct LampPoint {
    int light = -1;
    vec2 b{0};
};
inline LampPoint square_to_lamp(const std::vector<LampTriangle>& lamps, int first, const vec2& u) {
    if (lamps[first].partner == 0) return {first, square_to_triangle(u)};
    // (0, 0) is the first one's own corner, and the second is the first turned by half a turn.
    const bool second = u.x + u.y >= 1;
    return {first + second, second ? vec2(1.0f - u.x, 1.0f - u.y) : u};
}

// The same as the object's triangle counts its vertices.
TriangleHit hit_on_lamp(const LampTriangle& lamp, const Light& light, const vec2& b);

}  // namespace midway
