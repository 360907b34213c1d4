// An orthonormal frame around a normal; local z is the normal.
#pragma once

#include "math/lanes.h"

namespace midway {

struct Frame {
    vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

    vec3 to_local(const vec3& v) const { return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)}; }
    vec3 to_world(const vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

// The same around each of eight normals.
struct Frame8 {
    Vec3x8 s, t, n;

    Vec3x8 to_world(const Vec3x8& v) const { return s * v.x + t * v.y + n * v.z; }
};

// Frame around a unit normal, continuous except at n.z = 0 (Duff et al. 2017, "Building an
// Orthonormal Basis, Revisited", listing 3).
inline Frame frame_from_normal(const vec3& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {
        {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}
inline Frame8 frames_from_normals(const Vec3x8& n) {
    const Float8 sign = copy_sign(all_lanes(1.0f), n.z);
    const Float8 a = -1.0f / (sign + n.z);
    const Float8 b = n.x * n.y * a;
    return {
        {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace midway
