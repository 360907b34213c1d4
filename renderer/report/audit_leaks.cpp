#include "report/audit_leaks.h"

#include <cmath>

namespace midway {
namespace {

using Real = long double;
using Vec = glm::vec<3, Real>;

// A leak within so many error bounds of an edge is one that rounding explains.
constexpr double near_edge = 64;
// A hit so close to an edge may lie beyond the neighbour.
constexpr double touching = 4;

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

// Distance of a point on a triangle from the nearest of its edges.
Real distance_to_edge(const Object& o, int triangle, const Vec& point) {
    const uvec3& index = o.triangles[triangle];
    const Vec v[3] = {Vec(o.positions[index.x]), Vec(o.positions[index.y]),
                      Vec(o.positions[index.z])};
    Real distance = std::numeric_limits<Real>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vec e = v[(k + 1) % 3] - v[k], r = point - v[k];
        const Vec gap = r - e * std::clamp<Real>(dot(e, r) / dot(e, e), 0, 1);
        distance = std::min(distance, std::sqrt(dot(gap, gap)));
    }
    return distance;
}

// Where a ray crosses the plane of a triangle, in long double (Moeller & Trumbore 1997).
struct Crossing {
    bool inside = false, sees_front = false;
    Real t = 0;
};
Crossing cross_triangle(const Object& o, int triangle, const Vec& origin, const Vec& d) {
    const uvec3& index = o.triangles[triangle];
    const Vec v0(o.positions[index.x]);
    const Vec e1 = Vec(o.positions[index.y]) - v0, e2 = Vec(o.positions[index.z]) - v0;
    const Vec p = cross(d, e2);
    const Real det = dot(e1, p);
    if (det == 0) return {};
    const Vec s = origin - v0, q = cross(s, e1);
    const Real u = dot(s, p) / det, v = dot(d, q) / det;
    // The ray sees the front where it runs against the normal e1 x e2.
    return {u >= 0 && v >= 0 && u + v <= 1, det > 0, dot(e2, q) / det};
}

// What the ray meets first within [0, end], and how close it comes to an edge.
struct ExactRay {
    bool hit = false;
    Crossing first;
    Real edge_distance = std::numeric_limits<Real>::infinity();
};
ExactRay trace_exactly(const Object& o, const Vec& origin, const Vec& d, Real end, int skip = -1) {
    ExactRay result;
    for (int i = 0; i < static_cast<int>(o.triangles.size()); ++i) {
        const uvec3& index = o.triangles[i];
        const Vec v[3] = {Vec(o.positions[index.x]), Vec(o.positions[index.y]),
                          Vec(o.positions[index.z])};
        for (int k = 0; k < 3; ++k)
            result.edge_distance = std::min(result.edge_distance,
                                            distance_to_segment(origin, d, v[k], v[(k + 1) % 3]));
        const Crossing c = cross_triangle(o, i, origin, d);
        if (i == skip || !c.inside || !(c.t > 0) || c.t > end) continue;
        if (result.hit && c.t >= result.first.t) continue;
        result.hit = true;
        result.first = c;
    }
    return result;
}

// Is what was found what long double finds? Of surfaces that touch within rounding, either will do.
bool agree(const Object& o, const ExactRay& exact, const TriangleHit& found, const Vec& origin,
           const Vec& d, Real error) {
    if (!exact.hit || found.object < 0) return exact.hit == (found.object >= 0);
    const Crossing c = cross_triangle(o, found.triangle, origin, d);
    return std::abs(c.t - exact.first.t) * std::sqrt(dot(d, d)) <= touching * error;
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
    if (hit.object >= 0) {
        const bool sees_front =
            glm::dot(triangle_shape(o, hit.triangle).normal, leaving.ray.direction) < 0;
        if (sees_front == leaving.front) return {};
    }
    constexpr Real endless = std::numeric_limits<Real>::infinity();
    const Vec origin(leaving.ray.origin), d(leaving.ray.direction), start(leaving.start);
    const ExactRay exact = trace_exactly(o, origin, d, endless);
    // The offset may have carried the origin through a neighbour.
    const ExactRay offset = trace_exactly(o, start, origin - start, 1, leaving.triangle);
    // Or the hit itself, rounded, already lies beyond it.
    const Real start_distance = distance_to_edge(o, leaving.triangle, start);
    const bool beyond = start_distance <= touching * leaving.error;
    if (!beyond && !offset.hit && agree(o, exact, hit, origin, d, leaving.error))
        return {RayOutcome::overlap, 0};
    LeakFinding finding;
    finding.edge_distance = static_cast<double>(
        std::min({exact.edge_distance, offset.edge_distance, start_distance}) / leaving.error);
    finding.outcome =
        finding.edge_distance <= near_edge ? RayOutcome::leak : RayOutcome::unexplained;
    return finding;
}

}  // namespace midway
