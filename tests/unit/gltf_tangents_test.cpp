// Generated tangents: orientation, mirroring, sharing, and agreement with tangents made by others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/gltf.h"
#include "io/tangents.h"
#include "support/shared_data.h"

namespace midway::test {
namespace {

// The unit square facing +z with u to the right and, as glTF has it, v downwards.
Mesh square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {0, 0}, {1, 0}};
    mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
    return mesh;
}

TEST(Tangents, FollowIncreasingU) {
    Mesh mesh = square();
    generate_tangents(mesh, 0);
    ASSERT_EQ(mesh.tangents.size(), 4u);
    for (const vec4& tangent : mesh.tangents) EXPECT_EQ(tangent, vec4(1, 0, 0, 1));
}

TEST(Tangents, MirroredCoordinatesTurnTheHandedness) {
    Mesh mesh = square();
    for (vec2& uv : mesh.texcoords[0]) uv.x = 1 - uv.x;
    generate_tangents(mesh, 0);
    for (const vec4& tangent : mesh.tangents) EXPECT_EQ(tangent, vec4(-1, 0, 0, -1));
}

TEST(Tangents, VerticesBetweenBothSidesAreDoubled) {
    Mesh mesh = square();
    mesh.positions.push_back({2, 0, 0});
    mesh.normals.push_back({0, 0, 1});
    mesh.texcoords[0].push_back({0, 1});  // u runs back: mirrored about the edge x = 1
    mesh.triangles.push_back({3, 1, 4});
    generate_tangents(mesh, 0);
    EXPECT_EQ(mesh.positions.size(), 7u);
    EXPECT_EQ(mesh.tangents.size(), 7u);
    EXPECT_EQ(mesh.tangents[mesh.triangles[1].z].w, 1);
    EXPECT_EQ(mesh.tangents[mesh.triangles[2].x].w, -1);
}

TEST(Tangents, FlatMeshesGetOneVertexPerCorner) {
    Mesh mesh = square();
    mesh.normals.clear();
    generate_tangents(mesh, 0);
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_TRUE(mesh.normals.empty());
    for (const vec4& tangent : mesh.tangents) EXPECT_EQ(tangent, vec4(1, 0, 0, 1));
}

TEST(Tangents, WithoutUsableCoordinatesAreStillUnitAndPerpendicular) {
    Mesh mesh = square();
    mesh.texcoords[0].assign(4, vec2(0.5f));
    generate_tangents(mesh, 0);
    for (const vec4& tangent : mesh.tangents) {
        EXPECT_FLOAT_EQ(glm::length(vec3(tangent)), 1);
        EXPECT_EQ(tangent.z, 0);
    }
}

// The file brings its own tangents; how its exporter made them is not recorded.
TEST(Tangents, AgreeWithThoseOfAnExporter) {
    MIDWAY_SKIP_WITHOUT_SHARED("scenes/FlightHelmet/FlightHelmet.gltf");
    const SceneDescription scene =
        load_gltf(shared_path("scenes/FlightHelmet/FlightHelmet.gltf").string());
    std::vector<double> angles;
    std::size_t same_side = 0;
    for (const auto& shared : scene.meshes) {
        const Mesh& exported = *shared;
        if (exported.tangents.empty()) continue;
        Mesh mesh = exported;
        generate_tangents(mesh, 0);
        for (std::size_t i = 0; i < exported.tangents.size(); ++i) {
            const double cosine = glm::dot(vec3(mesh.tangents[i]), vec3(exported.tangents[i]));
            angles.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / 3.141592653589793);
            same_side += mesh.tangents[i].w == exported.tangents[i].w;
        }
    }
    ASSERT_GT(angles.size(), 10000u);
    std::sort(angles.begin(), angles.end());
    RecordProperty("median_degrees", std::to_string(angles[angles.size() / 2]));
    RecordProperty("degrees_at_95_percent", std::to_string(angles[angles.size() * 95 / 100]));
    EXPECT_LT(angles[angles.size() / 2], 2);
    EXPECT_LT(angles[angles.size() * 95 / 100], 20);
    EXPECT_GT(static_cast<double>(same_side) / static_cast<double>(angles.size()), 0.99);
}

}  // namespace
}  // namespace midway::test
