// libFuzzer target: any bytes as a scene file must load or throw std::runtime_error with one line.
// clang++ -std=c++20 -O1 -g -fsanitize=fuzzer,address,undefined -Irenderer tests/fuzz/fuzz_gltf.cpp
//     renderer/io/*.cpp -ldraco -lmeshoptimizer -o fuzz_gltf && ./fuzz_gltf -rss_limit_mb=4096
//     CORPUS
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "io/gltf.h"

namespace {

// What build_scene() and the kernels rely on.
void check(const midway::SceneDescription& scene) {
    for (const auto& shared : scene.meshes) {
        const midway::Mesh& mesh = *shared;
        const std::size_t count = mesh.positions.size();
        const auto whole = [&](std::size_t size) { return size == 0 || size == count; };
        if (mesh.triangles.empty() || !whole(mesh.normals.size()) || !whole(mesh.tangents.size()) ||
            !whole(mesh.colors.size()) || !whole(mesh.texcoords[0].size()) ||
            !whole(mesh.texcoords[1].size())) {
            std::abort();
        }
        for (const glm::uvec3& t : mesh.triangles) {
            if (t.x >= count || t.y >= count || t.z >= count) std::abort();
        }
        for (const glm::vec3& p : mesh.positions) {
            if (!midway::is_finite(p)) std::abort();
        }
        for (const glm::vec3& n : mesh.normals) {
            if (!midway::is_finite(n)) std::abort();
        }
    }
    for (const midway::Instance& instance : scene.instances) {
        if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size() ||
            instance.material < 0 ||
            static_cast<std::size_t>(instance.material) >= scene.materials.size()) {
            std::abort();
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        check(midway::load_gltf_from_memory({data, size}, "/nonexistent/scene.gltf"));
    } catch (const std::runtime_error& error) {
        if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
