// Meshes of glTF files: accessors of every kind, primitive modes, morph targets, skins, and what is
// mended or left out.
#include <gtest/gtest.h>

#include <limits>

#include "unit/gltf_test_files.h"

namespace midway::test {
namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

Mesh only_mesh(GltfFile& file) {
    const SceneDescription scene = file.load();
    EXPECT_EQ(scene.meshes.size(), 1u);
    return *scene.meshes.at(0);
}

TEST(GltfMesh, IndexedSquareWithoutNormalsStaysFlat) {
    GltfFile file;
    file.show(file.square_primitive());
    const Mesh mesh = only_mesh(file);
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.tangents.empty());
}

TEST(GltfMesh, TrianglesWithoutIndices) {
    GltfFile file;
    file.show({{"attributes", {{"POSITION", file.square()}}}});
    EXPECT_EQ(only_mesh(file).triangles, (std::vector<uvec3>{{0, 1, 2}}));
}

TEST(GltfMesh, StripAlternatesItsWinding) {
    GltfFile file;
    file.show({{"attributes", {{"POSITION", file.square()}}}, {"mode", 5}});
    EXPECT_EQ(only_mesh(file).triangles, (std::vector<uvec3>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(GltfMesh, FanTurnsAboutItsFirstVertex) {
    GltfFile file;
    const int ring = file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    file.show({{"attributes", {{"POSITION", ring}}}, {"mode", 6}});
    EXPECT_EQ(only_mesh(file).triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(GltfMesh, PointsAndLinesAreLeftOutWithAWarning) {
    GltfFile file;
    for (const int mode : {0, 1, 2, 3}) {
        file.show({{"attributes", {{"POSITION", file.square()}}}, {"mode", mode}});
    }
    const SceneDescription scene = file.load();
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(mentions(scene.warnings, "points or lines"));
}

TEST(GltfMesh, SparseValuesReplaceBase) {
    GltfFile file;
    const Json primitive = file.square_primitive();
    const int places = file.view(std::vector<std::uint8_t>{3});
    const int values = file.view(std::vector<float>{5, 6, 7});
    file.root["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", places}, {"componentType", type_ubyte}}},
        {"values", {{"bufferView", values}}}};
    file.show(primitive);
    const Mesh mesh = only_mesh(file);
    EXPECT_EQ(mesh.positions[2], vec3(0, 1, 0));
    EXPECT_EQ(mesh.positions[3], vec3(5, 6, 7));
}

TEST(GltfMesh, SparseWithoutBaseStartsFromZero) {
    GltfFile file;
    const int places = file.view(std::vector<std::uint8_t>{1, 2});
    const int values = file.view(std::vector<float>{1, 0, 0, 0, 1, 0});
    const int positions = file.add(
        "accessors", {{"componentType", type_float},
                      {"count", 3},
                      {"type", "VEC3"},
                      {"sparse",
                       {{"count", 2},
                        {"indices", {{"bufferView", places}, {"componentType", type_ubyte}}},
                        {"values", {{"bufferView", values}}}}}});
    file.show({{"attributes", {{"POSITION", positions}}}});
    EXPECT_EQ(only_mesh(file).positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(GltfMesh, QuantizedAttributesAreNormalizedAsTheAccessorSays) {
    GltfFile file;
    const int positions =
        file.accessor(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0},
                      "VEC3", type_short, 3, true);
    file.root["bufferViews"][0]["byteStride"] = 8;
    const int uv = file.accessor(std::vector<std::uint8_t>{0, 0, 255, 51, 0, 255}, "VEC2",
                                 type_ubyte, 3, true);
    file.show({{"attributes", {{"POSITION", positions}, {"TEXCOORD_1", uv}}}});
    file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    const Mesh mesh = only_mesh(file);
    EXPECT_EQ(mesh.positions[1], vec3(1, 0, 0));
    EXPECT_EQ(mesh.positions[2], vec3(0, -1, 0));
    EXPECT_EQ(mesh.texcoords[1][1], vec2(1, 0.2f));
    EXPECT_TRUE(mesh.texcoords[0].empty());
}

TEST(GltfMesh, UnnormalizedIntegersAreTakenAsTheyAre) {
    GltfFile file;
    const int positions = file.accessor(
        std::vector<std::int8_t>{0, 0, 0, 0, 100, 0, 0, 0, 0, -50, 0, 0}, "VEC3", type_byte, 3);
    file.root["bufferViews"][0]["byteStride"] = 4;
    file.show({{"attributes", {{"POSITION", positions}}}});
    EXPECT_EQ(only_mesh(file).positions[2], vec3(0, -50, 0));
}

TEST(GltfMesh, InterleavedAttributes) {
    GltfFile file;
    const int view = file.view(std::vector<float>{0, 0, 0, 0, 0, 1,  //
                                                  1, 0, 0, 0, 0, 1,  //
                                                  0, 1, 0, 0, 0, 1});
    file.root["bufferViews"][view]["byteStride"] = 24;
    Json entry = {
        {"bufferView", view}, {"componentType", type_float}, {"count", 3}, {"type", "VEC3"}};
    const int positions = file.add("accessors", entry);
    entry["byteOffset"] = 12;
    const int normals = file.add("accessors", entry);
    file.show({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    const Mesh mesh = only_mesh(file);
    EXPECT_EQ(mesh.positions[2], vec3(0, 1, 0));
    EXPECT_EQ(mesh.normals[2], vec3(0, 0, 1));
}

TEST(GltfMesh, VertexColoursOfThreeComponentsAreOpaque) {
    GltfFile file;
    Json primitive = file.square_primitive();
    primitive["attributes"]["COLOR_0"] =
        file.accessor(std::vector<std::uint16_t>{65535, 0, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0},
                      "VEC3", type_ushort, 4, true);
    file.show(primitive);
    EXPECT_EQ(only_mesh(file).colors[1], vec4(0, 1, 0, 1));
}

TEST(GltfMesh, MorphWeightsOfTheNodeOverrideTheMesh) {
    GltfFile file;
    Json primitive = file.square_primitive();
    primitive["targets"] = {
        {{"POSITION", file.floats({0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0, 4}, "VEC3")}}};
    file.show(primitive);
    file.root["meshes"][0]["weights"] = {0.5};
    file.add("nodes", {{"mesh", 0}, {"weights", {0.25}}});
    const SceneDescription scene = file.load();
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0]->positions[0].z, 2);
    EXPECT_EQ(scene.meshes[1]->positions[0].z, 1);
}

TEST(GltfMesh, SkinFollowsItsJointsAndNotItsNode) {
    GltfFile file;
    Json primitive = file.square_primitive();
    primitive["attributes"]["JOINTS_0"] =
        file.accessor(std::vector<std::uint8_t>(16, 0), "VEC4", type_ubyte, 4);
    primitive["attributes"]["WEIGHTS_0"] =
        file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    const int node = file.show(primitive);
    file.root["nodes"][node]["translation"] = {100, 0, 0};
    const int joint = file.add("nodes", {{"translation", {0, 0, 5}}});
    const int bind = file.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1}, "MAT4");
    file.root["skins"] = {{{"joints", {joint}}, {"inverseBindMatrices", bind}}};
    file.root["nodes"][node]["skin"] = 0;
    const SceneDescription scene = file.load();
    const Instance& instance = scene.instances.at(0);
    const dvec3 corner =
        dvec3(instance.to_world * dvec4(dvec3(scene.meshes.at(0)->positions[3]), 1));
    EXPECT_EQ(corner, dvec3(3, 1, 5));
}

TEST(GltfMesh, SkinWithJointsThatDoNotExistIsShownUnposed) {
    GltfFile file;
    Json primitive = file.square_primitive();
    primitive["attributes"]["JOINTS_0"] =
        file.accessor(std::vector<std::uint8_t>(16, 9), "VEC4", type_ubyte, 4);
    primitive["attributes"]["WEIGHTS_0"] = file.floats(std::vector<float>(16, 0.25f), "VEC4");
    const int node = file.show(primitive);
    file.root["skins"] = {
        {{"joints", {node}},
         {"inverseBindMatrices", file.floats(std::vector<float>(16, 1), "MAT4")}}};
    file.root["nodes"][node]["skin"] = 0;
    const SceneDescription scene = file.load();
    EXPECT_EQ(scene.meshes.at(0)->positions[3], vec3(1, 1, 0));
    EXPECT_TRUE(mentions(scene.warnings, "unposed"));
}

TEST(GltfMesh, UnusableTrianglesAreLeftOutAndCounted) {
    GltfFile file;
    const int positions = file.floats({0, 0, 0, 1,         0, 0, 0, 1, 0,  // good
                                       0, 0, 0, 1,         1, 1, 2, 2, 2,  // in one line
                                       0, 0, 0, nan_value, 0, 0, 0, 1, 0},
                                      "VEC3");
    file.show({{"attributes", {{"POSITION", positions}}}});
    const SceneDescription scene = file.load();
    EXPECT_EQ(scene.meshes.at(0)->triangles.size(), 1u);
    EXPECT_EQ(scene.meshes.at(0)->positions.size(), 3u);
    EXPECT_TRUE(mentions(scene.warnings, "1 triangles without area"));
    EXPECT_TRUE(mentions(scene.warnings, "1 triangles with infinite or undefined"));
}

TEST(GltfMesh, NormalsAreOfUnitLengthAndZeroOnesAreReplaced) {
    GltfFile file;
    Json primitive = file.square_primitive();
    primitive["attributes"]["NORMAL"] =
        file.floats({0, 0, 9, 0, 0, 0, nan_value, 0, 0, 0, 0.5f, 0}, "VEC3");
    file.show(primitive);
    const SceneDescription scene = file.load();
    EXPECT_EQ(scene.meshes.at(0)->normals,
              (std::vector<vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}}));
    EXPECT_TRUE(mentions(scene.warnings, "2 normals"));
}

TEST(GltfMesh, AttributeOfAnotherLengthIsLeftOut) {
    GltfFile file;
    Json primitive = file.square_primitive();
    primitive["attributes"]["NORMAL"] = file.floats({0, 0, 1}, "VEC3");
    file.show(primitive);
    const SceneDescription scene = file.load();
    EXPECT_TRUE(scene.meshes.at(0)->normals.empty());
    EXPECT_TRUE(mentions(scene.warnings, "NORMAL has 1 elements"));
}

}  // namespace
}  // namespace midway::test
