#include "scene/surface_lanes.h"

#include "math/in_place.h"
#include "scene/rounding.h"

namespace midway {
namespace {

struct Corners {
    Vec3x8 v0, v1, v2;
};

// What one object says of its lane: corners, and normals where it has them.
struct Gathered {
    Corners positions;
    Corners normals;
    Float8 b1, b2;
    Mask8 smooth{};  // has normals of its own
    Mask8 varied{};  // its Bsdf is another one at every point
};

void gather_corners(const std::vector<vec3>& values, const uvec3& t, int lane, Corners& c) {
    c.v0.set(lane, values[t.x]);
    c.v1.set(lane, values[t.y]);
    c.v2.set(lane, values[t.z]);
}

void gather(const Scene& s, const HitLanes& hits, const Mask8& met, Gathered& g) {
    for_each_lane(met, [&](int k) {
        const TriangleHit& hit = hits[k];
        const Object& o = s.geometry->objects[hit.object];
        const uvec3& t = o.triangles[hit.triangle];
        gather_corners(o.positions, t, k, g.positions);
        if (!o.normals.empty()) {
            gather_corners(o.normals, t, k, g.normals);
            g.smooth[k] = -1;
        }
        g.b1[k] = hit.b1;
        g.b2[k] = hit.b2;
        if (!s.even_surfaces[hit.object]) g.varied[k] = -1;
    });
}

Vec3x8 interpolate(const Corners& c, const Gathered& g, const Float8& b0) {
    return c.v0 * b0 + c.v1 * g.b1 + c.v2 * g.b2;
}

// As surface_point() and shading_normal().
Vec3x8 shading_normals(const Gathered& g, const Float8& b0, const Vec3x8& ng) {
    if (!any(g.smooth)) return ng;
    const Vec3x8 n = interpolate(g.normals, g, b0);
    const Float8 length = sqrt(dot(n, n));
    const Vec3x8 normal = select(g.smooth & (length > 0), n / length, ng);
    const Float8 c = dot(normal, ng);
    return select(c == 0, ng, select(c > 0, normal, -normal));
}

void set_bsdfs(const Scene& s, const HitLanes& hits, const Mask8& met, const Gathered& g,
               BsdfLanes& b, BsdfStore& store) {
    b.others = no_lane;
    for_each_lane(met, [&](int k) {
        const TriangleHit& hit = hits[k];
        const Bsdf* bsdf = &store[k];
        if (g.varied[k]) {
            const Object& o = s.geometry->objects[hit.object];
            build_at(store[k], [&] {
                return make_bsdf(s.materials[o.material], s.textures,
                                 surface_point(o, hit).shading);
            });
            b.normal.set(k, bsdf->frame.n);
        } else {
            bsdf = &*s.even_surfaces[hit.object];
        }
        b.diffuse.set(k, bsdf->only_diffuse ? bsdf->diffuse : vec3(0));
        if (bsdf->only_diffuse) return;
        b.others[k] = -1;
        b.other[k] = &store[k];
        if (g.varied[k]) return;
        store[k] = *bsdf;
        store[k].ng = b.ng[k];
        store[k].frame = frame_from_normal(b.normal[k]);
    });
}

}  // namespace

void surfaces_at(const Scene& scene, const HitLanes& hits, const Mask8& met, SurfaceLanes& s,
                 BsdfStore& store) {
    Gathered g{};
    gather(scene, hits, met, g);
    const Corners& c = g.positions;
    const Vec3x8 e1 = c.v1 - c.v0, e2 = c.v2 - c.v0;
    const Float8 extent = max_component(max(abs(e1), abs(e2)));
    const Float8 b0 = 1.0f - g.b1 - g.b2;
    s.position = interpolate(c, g, b0);
    s.error = rounding_error(max_component(abs(s.position)) + extent);
    s.bsdf.ng = normalize(cross(e1, e2));
    s.bsdf.normal = shading_normals(g, b0, s.bsdf.ng);
    set_bsdfs(scene, hits, met, g, s.bsdf, store);
}

}  // namespace midway
