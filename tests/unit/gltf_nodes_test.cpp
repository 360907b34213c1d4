// Nodes, cameras, lights and instances of glTF files.
#include <gtest/gtest.h>

#include "unit/gltf_test_files.h"

namespace midway::test {
namespace {

TEST(GltfNodes, EmptySceneLoadsWithNothingInIt) {
    GltfFile file;
    file.root["scenes"] = {{{"name", "nothing"}}};
    file.root["scene"] = 0;
    const SceneDescription scene = file.load();
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(scene.materials.empty());
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfNodes, FileWithoutScenesShowsAllRoots) {
    GltfFile file;
    const Json primitive = file.square_primitive();
    file.show(primitive);
    file.show(primitive);
    EXPECT_EQ(file.load().instances.size(), 2u);
}

TEST(GltfNodes, OnlyTheDefaultSceneIsShown) {
    GltfFile file;
    const Json primitive = file.square_primitive();
    file.root["nodes"] = Json::array();
    const int first = file.show(primitive), second = file.show(primitive);
    file.root["scenes"] = {{{"nodes", {first}}}, {{"nodes", {second}}}};
    file.root["nodes"][1]["name"] = "shown";
    file.root["scene"] = 1;
    const SceneDescription scene = file.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].name, "shown");
}

TEST(GltfNodes, TransformsMultiplyDownTheTreeInDouble) {
    GltfFile file;
    const int child = file.show(file.square_primitive());
    file.root["nodes"][child]["translation"] = {0.1, 0, 0};
    file.root["nodes"][child]["scale"] = {2, 3, 4};
    file.add("nodes", {{"children", {child}},
                       {"translation", {1e9, 0, 0}},
                       {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}});
    const SceneDescription scene = file.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    const dmat4& m = scene.instances[0].to_world;
    EXPECT_DOUBLE_EQ(m[3].x, 1e9);
    EXPECT_DOUBLE_EQ(m[3].y, 0.1);
    EXPECT_NEAR(m[0].y, 2, 1e-12);
    EXPECT_NEAR(m[1].x, -3, 1e-12);
    EXPECT_NEAR(m[2].z, 4, 1e-12);
}

TEST(GltfNodes, MatrixIsColumnMajor) {
    GltfFile file;
    const int node = file.show(file.square_primitive());
    file.root["nodes"][node]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
    EXPECT_EQ(dvec3(file.load().instances.at(0).to_world[3]), dvec3(5, 6, 7));
}

TEST(GltfNodes, MirroringIsPassedOnAsTheMatrixAlone) {
    GltfFile file;
    const int node = file.show(file.square_primitive());
    const SceneDescription plain = file.load();
    file.root["nodes"][node]["scale"] = {-1, 1, 1};
    const SceneDescription mirrored = file.load();
    EXPECT_LT(glm::determinant(dmat3(mirrored.instances.at(0).to_world)), 0);
    EXPECT_EQ(mirrored.meshes.at(0)->triangles, plain.meshes.at(0)->triangles);
    EXPECT_EQ(mirrored.meshes.at(0)->positions, plain.meshes.at(0)->positions);
}

TEST(GltfNodes, FlatteningIsBakedIntoTheMesh) {
    GltfFile file;
    Json primitive = file.square_primitive();
    primitive["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int node = file.show(primitive);
    file.root["nodes"][node]["scale"] = {2, 2, 0};
    file.root["nodes"][node]["translation"] = {10, 0, 0};
    const SceneDescription scene = file.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_DOUBLE_EQ(glm::determinant(dmat3(scene.instances[0].to_world)), 1);
    const dvec3 corner =
        dvec3(scene.instances[0].to_world * dvec4(dvec3(scene.meshes[0]->positions[3]), 1));
    EXPECT_EQ(corner, dvec3(12, 2, 0));
    EXPECT_EQ(scene.meshes[0]->normals[0], vec3(0, 0, 1));
}

TEST(GltfNodes, LoopIsAnError) {
    GltfFile file;
    file.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
    file.root["scenes"] = {{{"nodes", {0}}}};
    EXPECT_NE(file.error().find("loop"), std::string::npos);
}

TEST(GltfNodes, SharedNodeIsShownOnceWithAWarning) {
    GltfFile file;
    const int child = file.show(file.square_primitive());
    file.add("nodes", {{"children", {child}}});
    file.add("nodes", {{"children", {child}}});
    const SceneDescription scene = file.load();
    EXPECT_EQ(scene.instances.size(), 1u);
    EXPECT_TRUE(mentions(scene.warnings, "several parents"));
}

TEST(GltfNodes, MeshUsedTwiceIsReadOnce) {
    GltfFile file;
    file.show(file.square_primitive());
    file.add("nodes", {{"mesh", 0}, {"translation", {1, 0, 0}}});
    const SceneDescription scene = file.load();
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.instances.size(), 2u);
}

TEST(GltfNodes, PerspectiveCameraIsKeptOrthographicLeftOut) {
    GltfFile file;
    file.root["cameras"] = {
        {{"type", "perspective"},
         {"name", "eye"},
         {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 1.5}}}},
        {{"type", "orthographic"},
         {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}}};
    file.root["nodes"] = {{{"camera", 0}, {"translation", {0, 0, 3}}}, {{"camera", 1}}};
    const SceneDescription scene = file.load();
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "eye");
    EXPECT_DOUBLE_EQ(scene.cameras[0].yfov, 0.5);
    EXPECT_DOUBLE_EQ(scene.cameras[0].aspect_ratio.value(), 1.5);
    EXPECT_DOUBLE_EQ(scene.cameras[0].to_world[3].z, 3);
    EXPECT_TRUE(mentions(scene.warnings, "orthographic"));
}

TEST(GltfNodes, PunctualLightsOfAllKinds) {
    GltfFile file;
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 7}, {"range", 4}},
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}},
        {{"type", "directional"}, {"name", "sun"}}};
    for (int i = 0; i < 3; ++i) {
        file.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    }
    const SceneDescription scene = file.load();
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].kind, PunctualKind::point);
    EXPECT_EQ(scene.lights[0].color, vec3(1, 0.5f, 0));
    EXPECT_EQ(scene.lights[0].intensity, 7);
    EXPECT_EQ(scene.lights[0].range, 4);
    EXPECT_EQ(scene.lights[1].kind, PunctualKind::spot);
    EXPECT_FLOAT_EQ(scene.lights[1].inner_cone_angle, 0.2f);
    EXPECT_FLOAT_EQ(scene.lights[1].outer_cone_angle, 0.4f);
    EXPECT_EQ(scene.lights[2].kind, PunctualKind::directional);
    EXPECT_EQ(scene.lights[2].name, "sun");
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfNodes, InnerConeStaysInsideTheOuter) {
    GltfFile file;
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.9}, {"outerConeAngle", 0.4}}}}};
    file.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const SceneDescription scene = file.load();
    EXPECT_LT(scene.lights.at(0).inner_cone_angle, scene.lights.at(0).outer_cone_angle);
    EXPECT_TRUE(mentions(scene.warnings, "innerConeAngle"));
}

TEST(GltfNodes, GpuInstancingMultipliesAfterTheNode) {
    GltfFile file;
    const int node = file.show(file.square_primitive());
    const int places = file.floats({0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3");
    const int scales = file.floats({1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3");
    file.root["nodes"][node]["scale"] = {10, 10, 10};
    file.root["nodes"][node]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", places}, {"SCALE", scales}};
    file.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const SceneDescription scene = file.load();
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_DOUBLE_EQ(scene.instances[2].to_world[3].x, 20);
    EXPECT_DOUBLE_EQ(scene.instances[2].to_world[1].y, 30);
}

}  // namespace
}  // namespace midway::test
