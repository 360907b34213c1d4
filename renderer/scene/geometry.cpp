#include "scene/geometry.h"

#include "math/hash.h"
#include "scene/rounding.h"

namespace midway {
namespace {

template <class T>
T interpolate(const std::vector<T>& values, const uvec3& t, float b0, float b1, float b2) {
    return values[t.x] * b0 + values[t.y] * b1 + values[t.z] * b2;
}

// Inline here, for surface_point(): every hit goes through both.
inline FlatTriangle flatten(const Object& o, int triangle) {
    const uvec3& t = o.triangles[triangle];
    FlatTriangle f{o.positions[t.x], o.positions[t.y], o.positions[t.z]};
    const vec3 e1 = f.v1 - f.v0, e2 = f.v2 - f.v0;
    f.extent = max_component(glm::max(glm::abs(e1), glm::abs(e2)));
    f.ng = glm::normalize(glm::cross(e1, e2));
    return f;
}

inline TrianglePoint point_on(const FlatTriangle& t, float b1, float b2) {
    TrianglePoint p;
    p.position = t.v0 * (1 - b1 - b2) + t.v1 * b1 + t.v2 * b2;
    p.error = rounding_error(max_component(glm::abs(p.position)) + t.extent);
    p.ng = t.ng;
    return p;
}

}  // namespace

FlatTriangle flat_triangle(const Object& o, int triangle) { return flatten(o, triangle); }

TrianglePoint triangle_point(const FlatTriangle& t, float b1, float b2) {
    return point_on(t, b1, b2);
}

SurfacePoint surface_point(const Object& o, TriangleHit hit) {
    const uvec3& t = o.triangles[hit.triangle];
    const float b1 = hit.b1, b2 = hit.b2, b0 = 1 - b1 - b2;
    const TrianglePoint flat = point_on(flatten(o, hit.triangle), b1, b2);
    SurfacePoint p;
    p.hit = hit;
    p.position = flat.position;
    p.error = flat.error;
    p.shading.ng = p.shading.normal = flat.ng;
    p.shading.thin = !o.closed;
    if (!o.normals.empty()) {
        const vec3 n = interpolate(o.normals, t, b0, b1, b2);
        const float len = glm::length(n);
        if (len > 0) p.shading.normal = n / len;
    }
    if (!o.tangents.empty()) {
        p.shading.tangent = interpolate(o.tangents, t, b0, b1, b2);
        p.shading.tangent.w = o.tangents[t.x].w < 0 ? -1.0f : 1.0f;
    }
    for (int k = 0; k < 2; ++k)
        if (!o.texcoords[k].empty()) p.shading.uv[k] = interpolate(o.texcoords[k], t, b0, b1, b2);
    if (!o.colors.empty()) p.shading.color = interpolate(o.colors, t, b0, b1, b2);
    return p;
}

vec3 offset_origin(const vec3& position, const vec3& ng, float error, const vec3& towards) {
    return position + ng * std::copysign(error, glm::dot(ng, towards));
}

vec3 offset_end(const vec3& position, const vec3& ng, float error, const vec3& from) {
    const vec3 back = from - position;
    const float far_error = rounding_error(max_component(glm::abs(back)));
    return offset_origin(position, ng, error + far_error, back);
}

TriangleShape triangle_shape(const Object& o, int triangle) {
    const uvec3& t = o.triangles[triangle];
    const vec3 c =
        glm::cross(o.positions[t.y] - o.positions[t.x], o.positions[t.z] - o.positions[t.x]);
    const float len = glm::length(c);
    return {c / len, 0.5f * len};
}

bool is_closed_mesh(const std::vector<vec3>& positions, const std::vector<uvec3>& triangles) {
    std::vector<std::uint64_t> places;
    places.reserve(positions.size());
    for (const vec3& v : positions) {
        const vec3 p = v + 0.0f;  // one zero for both of float's
        places.push_back(hash_bytes(0, &p, sizeof p));
    }
    std::uint64_t balance = 0;
    for (const uvec3& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const std::uint64_t a = places[t[k]], b = places[t[(k + 1) % 3]];
            balance += a < b ? hash_combine(a, b) : -hash_combine(b, a);
        }
    return balance == 0 && !triangles.empty();
}

}  // namespace midway
