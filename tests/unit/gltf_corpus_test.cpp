// Every scene and every broken file of the optional data folder: loads or throws one line.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "io/gltf.h"
#include "support/shared_data.h"

namespace midway::test {
namespace {

std::vector<std::string> gltf_files(const std::string& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(shared_path(folder))) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

void expect_consistent(const SceneDescription& scene, const std::string& file) {
    for (const auto& shared : scene.meshes) {
        const Mesh& mesh = *shared;
        for (const uvec3& t : mesh.triangles) {
            ASSERT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size()) << file;
        }
        for (const std::size_t size :
             {mesh.normals.size(), mesh.tangents.size(), mesh.colors.size(),
              mesh.texcoords[0].size(), mesh.texcoords[1].size()}) {
            ASSERT_TRUE(size == 0 || size == mesh.positions.size()) << file;
        }
    }
    for (const Instance& instance : scene.instances) {
        ASSERT_LT(static_cast<std::size_t>(instance.mesh), scene.meshes.size()) << file;
        ASSERT_LT(static_cast<std::size_t>(instance.material), scene.materials.size()) << file;
    }
    for (const std::string& line : scene.warnings) {
        ASSERT_EQ(line.find('\n'), std::string::npos) << file << ": " << line;
    }
}

TEST(GltfCorpus, BrokenFilesLoadOrThrowOneLine) {
    MIDWAY_SKIP_WITHOUT_SHARED("hostile");
    std::size_t loaded = 0, refused = 0;
    for (const std::string& file : gltf_files("hostile")) {
        try {
            expect_consistent(load_gltf(file), file);
            ++loaded;
        } catch (const std::runtime_error& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            ++refused;
        }
    }
    EXPECT_GT(loaded + refused, 0u);
    RecordProperty("loaded", std::to_string(loaded));
    RecordProperty("refused", std::to_string(refused));
}

// Only an extension that the file requires and we lack may keep a good scene from loading.
TEST(GltfCorpus, GoodScenesLoad) {
    MIDWAY_SKIP_WITHOUT_SHARED("scenes");
    for (const std::string& file : gltf_files("scenes")) {
        try {
            expect_consistent(load_gltf(file), file);
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find("requires the extension"), std::string::npos)
                << error.what();
        }
    }
}

// One scene in three encodings. Quantisation moves vertices by up to 1/2^14 of the size.
TEST(GltfCorpus, CompressedCopiesOfASceneAgree) {
    MIDWAY_SKIP_WITHOUT_SHARED("scenes/suzanne-pmndrs/suzi.meshopt.glb");
    const auto bounds = [](const char* name) {
        const SceneDescription scene =
            load_gltf(shared_path(std::string("scenes/suzanne-pmndrs/") + name).string());
        dvec3 low(1e30), high(-1e30);
        for (const Instance& instance : scene.instances) {
            const Mesh& mesh = *scene.meshes[static_cast<std::size_t>(instance.mesh)];
            EXPECT_EQ(mesh.triangles.size(), 15744u);
            for (const vec3& p : mesh.positions) {
                const dvec3 world = dvec3(instance.to_world * dvec4(dvec3(p), 1));
                low = glm::min(low, world);
                high = glm::max(high, world);
            }
        }
        return std::make_pair(low, high);
    };
    const auto plain = bounds("suzi.glb");
    const double size = glm::length(plain.second - plain.first);
    for (const char* name : {"suzi.quantized.glb", "suzi.meshopt.glb"}) {
        const auto copy = bounds(name);
        EXPECT_LT(glm::length(copy.first - plain.first), 1e-3 * size) << name;
        EXPECT_LT(glm::length(copy.second - plain.second), 1e-3 * size) << name;
    }
}

}  // namespace
}  // namespace midway::test
