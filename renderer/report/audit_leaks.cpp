#include "report/audit_leaks.h"

#include <cmath>

namespace midway {
namespace {

using Real = long double;
using Vec = glm::vec<3, Real>;

// A leak within so many error bounds of an edge is one that rounding explains.
constexpr double near_edge = 64;

Real dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Six times the volume that the mesh encloses; positive where fronts look outwards.
Real signed_volume(const Object& o) {
    Real volume = 0;
    for (const uvec3& t : o.triangles)
        volume += dot(Vec(o.positions[t.x]), cross(Vec(o.positions[t.y]), Vec(o.positions[t.z])));
    return volume;
}

// Distance between a half line and a segment (Ericson 2005, "Real-Time Collision Detection",
// section 5.1.9, with the first parameter unbounded above).
Real distance_to_segment(const Vec& origin, const Vec& d, const Vec& a, const Vec& b) {
    const Vec e = b - a, r = origin - a;
    const Real dd = dot(d, d), ee = dot(e, e), de = dot(d, e), dr = dot(d, r), er = dot(e, r);
    const Real det = dd * ee - de * de;
    Real u = det > 0 ? (dd * er - de * dr) / det : 0;  // along the segment
    u = std::clamp<Real>(u, 0, 1);
    const Real t = std::max<Real>(0, (u * de - dr) / dd);
    // With the half line's end known, the segment's closest point once more.
    if (ee > 0) u = std::clamp<Real>((t * de + er) / ee, 0, 1);
    const Vec gap = r + d * t - e * u;
    return std::sqrt(dot(gap, gap));
}

// What the ray meets first in long double, by Moeller and Trumbore (1997), and how close it comes
// to an edge.
struct ExactRay {
    bool hit = false, sees_front = false;
    Real t = 0;
    Real edge_distance = std::numeric_limits<Real>::infinity();
};

ExactRay trace_exactly(const Object& o, const Ray& ray) {
    ExactRay result;
    const Vec origin(ray.origin), d(ray.direction);
    for (const uvec3& index : o.triangles) {
        const Vec v0(o.positions[index.x]), v1(o.positions[index.y]), v2(o.positions[index.z]);
        for (const auto& [a, b] : {std::pair{v0, v1}, {v1, v2}, {v2, v0}})
            result.edge_distance =
                std::min(result.edge_distance, distance_to_segment(origin, d, a, b));
        const Vec e1 = v1 - v0, e2 = v2 - v0, p = cross(d, e2);
        const Real det = dot(e1, p);
        if (det == 0) continue;
        const Vec s = origin - v0, q = cross(s, e1);
        const Real u = dot(s, p) / det, v = dot(d, q) / det, t = dot(e2, q) / det;
        if (u < 0 || v < 0 || u + v > 1 || !(t > 0) || (result.hit && t >= result.t)) continue;
        result.hit = true;
        result.t = t;
        result.sees_front = det > 0;  // the ray runs against the normal e1 x e2
    }
    return result;
}

}  // namespace

std::vector<std::unique_ptr<ClosedMesh>> closed_meshes(const Scene& scene, size_t most) {
    std::vector<std::unique_ptr<ClosedMesh>> meshes(scene.geometry->objects.size());
    size_t found = 0;
    for (size_t i = 0; i < meshes.size() && found < most; ++i) {
        const Object& o = scene.geometry->objects[i];
        if (!is_closed_mesh(o.positions, o.triangles)) continue;
        const Real volume = signed_volume(o);
        if (volume == 0) continue;
        ++found;
        auto geometry = std::make_shared<Geometry>();
        Object alone;
        alone.name = o.name;
        alone.positions = o.positions;
        alone.triangles = o.triangles;
        geometry->objects.push_back(std::move(alone));
        geometry->triangle_count = o.triangles.size();
        meshes[i] = std::make_unique<ClosedMesh>();
        meshes[i]->geometry = geometry;
        meshes[i]->accel = std::make_unique<Accel>(geometry);
        meshes[i]->front_bounded = volume < 0;
    }
    return meshes;
}

LeakFinding follow(const ClosedMesh& mesh, const LeavingRay& leaving) {
    const Object& o = mesh.object();
    const TriangleHit hit = mesh.accel->closest(leaving.ray, {}, 0);
    const bool must_hit = leaving.front == mesh.front_bounded;
    if (hit.object < 0 && !must_hit) return {};
    bool sees_front = false;
    if (hit.object >= 0) {
        sees_front = glm::dot(triangle_shape(o, hit.triangle).normal, leaving.ray.direction) < 0;
        if (sees_front == leaving.front) return {};
    }
    const ExactRay exact = trace_exactly(o, leaving.ray);
    Ray start = leaving.ray;
    start.origin = leaving.start;
    const Real edge =
        std::min(exact.edge_distance, trace_exactly(o, start).edge_distance) / leaving.error;
    LeakFinding finding;
    finding.edge_distance = static_cast<double>(edge);
    const bool same =
        exact.hit == (hit.object >= 0) && (!exact.hit || exact.sees_front == sees_front);
    finding.outcome = finding.edge_distance <= near_edge ? RayOutcome::leak
                      : same                             ? RayOutcome::overlap
                                                         : RayOutcome::unexplained;
    return finding;
}

}  // namespace midway
