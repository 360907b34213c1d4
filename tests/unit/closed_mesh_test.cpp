// Whether a mesh is closed, against the definition: every edge counted in a map.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "scene/geometry.h"
#include "support/scenes.h"

namespace midway::test {
namespace {

bool closed_by_definition(const std::vector<vec3>& positions, const std::vector<uvec3>& triangles) {
    using Point = std::tuple<float, float, float>;
    std::map<std::pair<Point, Point>, int> edges;
    for (const uvec3& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const vec3 &a = positions[t[k]], &b = positions[t[(k + 1) % 3]];
            ++edges[{{a.x, a.y, a.z}, {b.x, b.y, b.z}}];
            --edges[{{b.x, b.y, b.z}, {a.x, a.y, a.z}}];
        }
    for (const auto& [edge, balance] : edges)
        if (balance != 0) return false;
    return !triangles.empty();
}

TEST(ClosedMesh, IsWhatTheDefinitionSays) {
    std::mt19937 random(2);
    int closed = 0, open = 0;
    const Mesh ball = make_icosphere({0, 0, 0}, 1, 2, false, true);
    for (int i = 0; i < 400; ++i) {
        std::vector<vec3> p = ball.positions;
        std::vector<uvec3> t = ball.triangles;
        std::shuffle(t.begin(), t.end(), random);
        // Some triangles out, turned round or there again; some vertices apart from their copies.
        if (i % 4 == 1) t.resize(t.size() - 1 - random() % 5);
        if (i % 4 == 2) std::swap(t[random() % t.size()].x, t[random() % t.size()].y);
        if (i % 8 == 3) t.push_back(t[random() % t.size()]);
        if (i % 8 == 7) {
            const uvec3 twice = t[random() % t.size()];
            t.push_back(twice);
            t.emplace_back(twice.x, twice.z, twice.y);
        }
        for (uvec3& corner : t)
            if (random() % 2) {
                p.push_back(p[corner.x]);
                corner.x = static_cast<unsigned>(p.size()) - 1;
            }
        const bool expected = closed_by_definition(p, t);
        EXPECT_EQ(is_closed_mesh(p, t), expected) << i;
        ++(expected ? closed : open);
    }
    EXPECT_GT(closed, 100);
    EXPECT_GT(open, 100);
}

TEST(ClosedMesh, BothZerosAreOnePlace) {
    std::vector<vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0.0f, 0, -0.0f}};
    EXPECT_TRUE(is_closed_mesh(p, {{0, 2, 1}, {4, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
    EXPECT_FALSE(is_closed_mesh(p, {}));
    EXPECT_FALSE(is_closed_mesh(p, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}}));
}

}  // namespace
}  // namespace midway::test
