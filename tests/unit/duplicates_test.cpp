// Triangles that a file holds twice.
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace midway::test {
namespace {

Mesh twice(Mesh m, bool turned_round, int rotate) {
    const std::vector<uvec3> once = m.triangles;
    for (uvec3 t : once) {
        for (int k = 0; k < rotate; ++k) t = {t.y, t.z, t.x};
        if (turned_round) std::swap(t.y, t.z);
        m.triangles.push_back(t);
    }
    return m;
}

const Mesh quad = make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});

Scene build_with_warnings(const SceneDescription& d, size_t warnings) {
    std::vector<std::string> lines;
    Scene s = build_scene(d, lines);
    EXPECT_EQ(lines.size(), warnings);
    return s;
}

TEST(Duplicates, AreLeftOutOfAMesh) {
    for (int rotate = 0; rotate < 3; ++rotate) {
        SceneDescription d;
        add(d, twice(quad, false, rotate), lamp(vec3(1)));
        const Scene s = build_with_warnings(d, 1);
        EXPECT_EQ(s.geometry->triangle_count, 2u);
        EXPECT_EQ(s.geometry->duplicates, 2u);
        EXPECT_EQ(s.lights.size(), 2u);
    }
}

TEST(Duplicates, AreLeftOutOfASecondInstanceOfTheSameMaterial) {
    SceneDescription d;
    add(d, quad, lamp(vec3(1)));
    d.instances.push_back(d.instances.front());
    const Scene s = build_with_warnings(d, 1);
    EXPECT_EQ(s.geometry->objects.size(), 1u);
    EXPECT_EQ(s.first_light, std::vector<int>{0});
    EXPECT_EQ(s.lights.size(), 2u);
}

TEST(Duplicates, BacksOtherMaterialsAndTransparentSheetsStay) {
    SceneDescription d;
    add(d, twice(quad, true, 0), lambert(vec3(0.5f)));
    EXPECT_EQ(build_with_warnings(d, 0).geometry->triangle_count, 4u);
    add(d, quad, lambert(vec3(0.2f)));
    EXPECT_EQ(build_with_warnings(d, 0).geometry->triangle_count, 6u);
    Material sheet = lambert(vec3(1));
    sheet.alpha_mode = AlphaMode::blend;
    sheet.alpha = 0.5f;
    add(d, twice(quad, false, 0), sheet);
    EXPECT_EQ(build_with_warnings(d, 0).geometry->triangle_count, 10u);
}

// Zeros of both signs are one place.
TEST(Duplicates, AreFoundAcrossTheSignOfZero) {
    Mesh m = quad;
    m.positions.insert(m.positions.end(), quad.positions.begin(), quad.positions.end());
    m.texcoords[0].clear();
    m.tangents.clear();
    for (size_t i = 4; i < 8; ++i) m.positions[i].y = -0.0f;
    for (const uvec3& t : quad.triangles) m.triangles.push_back(t + 4u);
    SceneDescription d;
    add(d, m, lamp(vec3(1)));
    EXPECT_EQ(build_with_warnings(d, 1).geometry->triangle_count, 2u);
}

}  // namespace
}  // namespace midway::test
