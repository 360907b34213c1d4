#include "scene/scene.h"

#include "math/in_place.h"

namespace midway {

float AlphaLookup::operator()(const TriangleHit& hit) const {
    const Object& o = scene->geometry->objects[hit.object];
    return material_alpha(scene->materials[o.material], scene->textures,
                          surface_point(o, hit).shading);
}

std::optional<SurfacePoint> intersect(const Scene& s, const Ray& ray, std::uint64_t coin) {
    return surface_at(s, s.accel->closest(ray, {&s}, coin));
}

std::optional<SurfacePoint> surface_at(const Scene& s, const TriangleHit& hit) {
    std::optional<SurfacePoint> point;
    if (hit.object < 0) return point;
    build_at(point.emplace(), [&] { return surface_point(s.geometry->objects[hit.object], hit); });
    return point;
}

float visibility(const Scene& s, const vec3& from, const vec3& to) {
    return s.accel->transmittance({from, to - from, 1.0f}, {&s});
}

float visibility_to_infinity(const Scene& s, const vec3& from, const vec3& direction) {
    return s.accel->transmittance({from, direction}, {&s});
}

}  // namespace midway
