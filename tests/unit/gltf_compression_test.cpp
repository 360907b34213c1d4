// Draco and meshopt compression: what is encoded here comes back, and damaged data is an error.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "unit/gltf_test_files.h"

namespace midway::test {
namespace {

// A square of which vertices and indices are meshopt-compressed.
void add_meshopt_square(GltfFile& file) {
    const std::vector<float> vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const std::vector<unsigned> indices = {0, 1, 2, 2, 1, 3};
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(4, 12));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), vertices.data(), 4, 12));
    const auto compress = [&](const std::vector<unsigned char>& data, const Json& parameters,
                              std::size_t length) {
        const int view = file.view(data);
        Json& entry = file.root["bufferViews"][view];
        Json meshopt = parameters;
        meshopt["buffer"] = 0;
        meshopt["byteOffset"] = entry["byteOffset"];
        meshopt["byteLength"] = entry["byteLength"];
        entry = {{"buffer", 1},
                 {"byteLength", length},
                 {"extensions", {{"EXT_meshopt_compression", meshopt}}}};
        return view;
    };
    const int positions =
        compress(packed, {{"byteStride", 12}, {"count", 4}, {"mode", "ATTRIBUTES"}}, 48);
    packed.assign(meshopt_encodeIndexBufferBound(6, 4), 0);
    packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), 6));
    const int triangles =
        compress(packed, {{"byteStride", 4}, {"count", 6}, {"mode", "TRIANGLES"}}, 24);
    file.add(
        "accessors",
        {{"bufferView", positions}, {"componentType", type_float}, {"count", 4}, {"type", "VEC3"}});
    file.add("accessors", {{"bufferView", triangles},
                           {"componentType", type_uint},
                           {"count", 6},
                           {"type", "SCALAR"}});
    file.show({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
    file.root["extensionsRequired"] = {"EXT_meshopt_compression"};
    file.root["buffers"] = {
        {{"uri", "scene.bin"}, {"byteLength", file.binary.size()}},
        {{"byteLength", 72}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    write_file(file.folder / "scene.bin", file.binary);
}

TEST(GltfCompression, MeshoptComesBack) {
    GltfFile file;
    add_meshopt_square(file);
    const Mesh mesh = *file.load().meshes.at(0);
    EXPECT_EQ(mesh.positions.at(3), vec3(1, 1, 0));
    EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(GltfCompression, MeshoptWithImpossibleParametersIsAnError) {
    const auto edited = [](const char* key, const Json& value) {
        GltfFile file;
        add_meshopt_square(file);
        file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
        return file.error();
    };
    EXPECT_EQ(edited("filter", "NONE"), "");
    EXPECT_NE(edited("byteStride", 0), "");
    EXPECT_NE(edited("byteStride", 13), "");
    EXPECT_NE(edited("count", ~std::uint64_t{0}), "");
    EXPECT_NE(edited("count", 1u << 31), "");
    EXPECT_NE(edited("byteLength", 1u << 20), "");
    EXPECT_NE(edited("buffer", 5), "");
    EXPECT_NE(edited("mode", "TRIANGLES"), "");
    EXPECT_NE(edited("mode", "NOISE"), "");
    EXPECT_NE(edited("filter", "QUATERNION"), "");
}

TEST(GltfCompression, DamagedMeshoptIsAnError) {
    GltfFile file;
    add_meshopt_square(file);
    write_file(file.folder / "scene.bin", std::string(file.binary.size(), 'x'));
    EXPECT_NE(file.error(), "");
}

std::vector<char> draco_square() {
    const float corners[2][3][3] = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                    {{0, 1, 0}, {1, 0, 0}, {1, 1, 0}}};
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int position =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (int f = 0; f < 2; ++f) {
        builder.SetAttributeValuesForFace(position, draco::FaceIndex(static_cast<unsigned>(f)),
                                          corners[f][0], corners[f][1], corners[f][2]);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {buffer.data(), buffer.data() + buffer.size()};
}

void add_draco_square(GltfFile& file) {
    const int view = file.view(draco_square());
    file.add("accessors", {{"componentType", type_float}, {"count", 4}, {"type", "VEC3"}});
    file.add("accessors", {{"componentType", type_uint}, {"count", 6}, {"type", "SCALAR"}});
    file.show({{"attributes", {{"POSITION", 0}}},
               {"indices", 1},
               {"extensions",
                {{"KHR_draco_mesh_compression",
                  {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}}}}}});
    file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
}

TEST(GltfCompression, DracoComesBack) {
    GltfFile file;
    add_draco_square(file);
    const Mesh mesh = *file.load().meshes.at(0);
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    double area = 0;
    for (const uvec3& t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x];
        area += glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a).z / 2;
    }
    EXPECT_DOUBLE_EQ(area, 1);
}

TEST(GltfCompression, DamagedDracoIsAnError) {
    GltfFile file;
    add_draco_square(file);
    const std::string good = file.binary;
    for (std::size_t i = good.size(); i-- > 0;) {
        file.binary = good.substr(0, i) + std::string(good.size() - i, '\xff');
        file.root.erase("buffers");
        const std::string message = file.error();  // what is left of the data may still decode
        EXPECT_EQ(message.find('\n'), std::string::npos);
        if (i == 0) {
            EXPECT_NE(message, "");
        }
    }
}

TEST(GltfCompression, DracoReferencesAreChecked) {
    const auto edited = [](const char* key, const Json& value) {
        GltfFile file;
        add_draco_square(file);
        file.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"][key] =
            value;
        return file.error();
    };
    EXPECT_NE(edited("bufferView", 7), "");
    EXPECT_NE(edited("bufferView", -1), "");
    EXPECT_NE(edited("attributes", {{"POSITION", 9}}), "");
    EXPECT_NE(edited("attributes", {{"NORMAL", 0}}), "");
    EXPECT_NE(edited("attributes", 3), "");
}

}  // namespace
}  // namespace midway::test
