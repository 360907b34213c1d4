// Rays that leave what they hit, from 2^-20 to 2^20 in size, normalised and traced in the file's
// own coordinates: none meets the triangle it leaves, closed meshes let none through. Paths are
// fixed, so there is no false alarm; the quick tier traces some 4e5 rays, the full one 1e8.
#include "report/audit_rays.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <iostream>

#include "math/float_mode.h"
#include "math/warp.h"
#include "report/audit_leaks.h"
#include "support/scenes.h"
#include "support/tier.h"

namespace midway::test {
namespace {

// A tetrahedron: every edge sharp, seen from inside an angle of 70 degrees.
Mesh make_tetrahedron(const vec3& center, float size) {
    Mesh m;
    m.positions = {vec3(1, 1, 1), vec3(1, -1, -1), vec3(-1, 1, -1), vec3(-1, -1, 1)};
    for (vec3& p : m.positions) p = center + p * size;
    m.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    return m;
}

// Spindles whose triangles are a thousand times as long as wide.
Mesh make_spindle(const vec3& center, float length) {
    Mesh m = make_icosphere(center, length, 2);
    for (vec3& p : m.positions) p = center + (p - center) * vec3(1e-3f, 1, 1e-3f);
    return m;
}

// Closed bodies of every kind in a closed room, all in units of `scale`.
SceneDescription bodies(double scale) {
    SceneDescription d;
    const dmat4 size = glm::scale(dmat4(1), dvec3(scale));
    add(d, make_icosphere({0, 0, 0}, 4, 2, true), lambert(vec3(0.7f)), size);
    add(d, make_icosphere({1, 0.2f, 0}, 0.7f, 4, false, true), metal(0.3f), size);
    add(d, make_icosphere({-1, 0.3f, 0.5f}, 0.6f, 3), glass(0.0f), size);
    add(d, make_icosphere({-0.6f, -0.9f, 1}, 0.05f, 3), glass(0.4f), size);
    add(d, make_tetrahedron({0.2f, -1, 0.4f}, 0.5f), lambert(vec3(0.8f)), size);
    add(d, make_tetrahedron({0.3f, 1.3f, -0.4f}, 0.4f), glass(0.0f), size);
    add(d, make_spindle({1.6f, -0.5f, 0.9f}, 1.2f), lambert(vec3(0.8f)), size);
    add(d, make_quad({-0.5f, 3, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(5)), size);
    return d;
}

CameraDescription camera_for(double scale) {
    CameraDescription c = camera_at({0, 0, 3}, {0, 0, 0}, 1.2);
    c.to_world[3] = dvec4(dvec3(c.to_world[3]) * scale, 1);
    return c;
}

RayAudit trace(int octave, bool normalise, std::int64_t rays) {
    const double scale = std::ldexp(1.0, octave);
    std::vector<std::string> warnings;
    BuildOptions options;
    options.normalise = normalise;
    const Scene scene = build_scene(bodies(scale), warnings, options);
    RenderSettings s = settings(Technique::bdpt, 24);
    s.seed = static_cast<std::uint64_t>(octave + 100);
    return audit_rays(make_estimator(scene, camera_for(scale), s), {rays, 1, {}});
}

std::string text(const RayAudit& r) {
    return std::to_string(r.rays) + " rays, self-hits " + std::to_string(r.self_hits.count) +
           "; closed " + std::to_string(r.closed_rays) + ", leaks " +
           std::to_string(r.leaks.count) + " (at most " + std::to_string(r.farthest_leak) +
           " error bounds from an edge), elsewhere " + std::to_string(r.unexplained.count) +
           ", overlaps " + std::to_string(r.overlaps) + "; edges " + std::to_string(r.edges) +
           ", blocked " + std::to_string(r.blocked.count) + "; pairs " + std::to_string(r.pairs) +
           ", unequal " + std::to_string(r.unequal.count) + "; stopped " +
           std::to_string(r.stopped);
}

TEST(AuditRays, NeitherSelfHitsNorLeaksOverFortyOctaves) {
    RayAudit all;
    for (const bool normalise : {true, false})
        for (int octave = -20; octave <= 20; ++octave) {
            // A power of two leaves a normalised scene as it is, so a few stand for all.
            if (normalise && octave % 10 != 0) continue;
            const RayAudit r = trace(octave, normalise, by_tier(8000, 2'200'000));
            EXPECT_EQ(0u, r.self_hits.count) << "2^" << octave << ": " << text(r);
            EXPECT_EQ(0u, r.unexplained.count) << "2^" << octave << ": " << text(r);
            EXPECT_EQ(0u, r.overlaps) << "2^" << octave << ": " << text(r);
            all.merge(r);
        }
    std::cout << text(all) << "\n";
    EXPECT_GE(all.rays, by_tier(300000u, 100'000'000u));
    EXPECT_GT(all.closed_rays, all.rays / 2);
    EXPECT_LE(double(all.leaks.count), 3 + 1e-7 * double(all.closed_rays));
    // What a walk sees a connection must see: shadow rays are offset at both ends.
    EXPECT_LE(double(all.blocked.count), 3 + 1e-5 * double(all.edges));
    EXPECT_LE(double(all.unequal.count), 3 + 1e-4 * double(all.pairs));
}

// Small triangles seen from a thousand of their sizes away: at the far end of a shadow ray rounding
// grows with its length, and they must not hide behind themselves.
TEST(AuditRays, SmallFarTrianglesDoNotHideBehindThemselves) {
    const ScopedFlushToZero flush;
    SceneDescription d;
    add(d, make_icosphere({0, 0, 0}, 0.001f, 3), lambert(vec3(0.8f)));
    add(d, make_quad({0.9f, -0.1f, -0.1f}, {0, 0.2f, 0}, {0, 0, 0.2f}), lambert(vec3(0.8f)));
    // One on the other side keeps the ball at the origin, where its own error bound is small.
    add(d, make_quad({-0.9f, -0.1f, -0.1f}, {0, 0.2f, 0}, {0, 0, 0.2f}), lambert(vec3(0.8f)));
    const std::shared_ptr<const Scene> scene = build(d);
    const Object& ball = scene->geometry->objects[0];
    const vec3 from = scene->geometry->objects[1].positions[0] - vec3(0.1f, 0, 0);
    int seen = 0, tried = 0;
    for (int t = 0; t < static_cast<int>(ball.triangles.size()); ++t)
        for (const vec2 b : {vec2(0.3f, 0.3f), vec2(0.1f, 0.8f), vec2(0.01f, 0.02f)}) {
            const SurfacePoint p = surface_point(ball, {0, t, b.x, b.y});
            if (glm::dot(p.shading.ng, from - p.position) <= 0) continue;
            ++tried;
            seen +=
                visibility(*scene, from, offset_end(p.position, p.shading.ng, p.error, from)) > 0;
        }
    ASSERT_GT(tried, 300);
    EXPECT_EQ(tried, seen);
}

// The detector itself: a ray that starts beyond a neighbour's plane is found, one that starts where
// it says it does is not.
TEST(AuditRays, PlantedLeaksAreFound) {
    const ScopedFlushToZero flush;
    SceneDescription d;
    add(d, make_tetrahedron({0, 0, 0}, 1), lambert(vec3(0.8f)));
    const std::shared_ptr<const Scene> scene = build(d);
    const auto closed = closed_meshes(*scene, 10);
    ASSERT_TRUE(closed[0]);
    const Object& o = closed[0]->object();
    for (int t = 0; t < 4; ++t) {
        const SurfacePoint p = surface_point(o, {0, t, 0.3f, 0.3f});
        LeavingRay inside{
            {offset_origin(p.position, p.shading.ng, p.error, -p.shading.ng), -p.shading.ng},
            p.position,
            p.error,
            t,
            false};
        EXPECT_EQ(RayOutcome::as_it_must, follow(*closed[0], inside).outcome);
        // Near an edge an offset of many error bounds carries the origin through the neighbour.
        const SurfacePoint edge = surface_point(o, {0, t, 0.5f, 1e-6f});
        const vec3 direction = -edge.shading.ng;
        LeavingRay through{{edge.position + direction * (40 * edge.error), direction},
                           edge.position,
                           edge.error,
                           t,
                           false};
        EXPECT_EQ(RayOutcome::leak, follow(*closed[0], through).outcome) << t;
        // And one that is said to leave on the wrong side, far from any edge, is another mesh.
        inside.front = true;
        EXPECT_EQ(RayOutcome::overlap, follow(*closed[0], inside).outcome) << t;
    }
}

TEST(AuditRays, OpenMeshesAreNotTakenForClosed) {
    SceneDescription d;
    Mesh open = make_icosphere({0, 0, 0}, 1, 2);
    open.triangles.pop_back();
    add(d, open, lambert(vec3(0.8f)));
    add(d, make_icosphere({0, 0, 0}, 0.5f, 2, true), lambert(vec3(0.8f)));
    const auto closed = closed_meshes(*build(d), 10);
    EXPECT_FALSE(closed[0]);
    ASSERT_TRUE(closed[1]);
    EXPECT_TRUE(closed[1]->front_bounded);
}

}  // namespace
}  // namespace midway::test
