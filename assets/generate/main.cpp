// midway-assets OUTDIR: writes the project's own scenes.
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "scenes.h"

namespace {

void write_file(const std::string& path, const std::string& bytes) {
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file)
        throw std::runtime_error("cannot write (" + path + "); check the folder and its rights");
    std::printf("%s: %zu bytes\n", path.c_str(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
    using namespace midway::assets;
    if (argc != 2) {
        std::fprintf(stderr, "usage: midway-assets OUTDIR\n");
        return 2;
    }
    try {
        const std::string folder = argv[1];
        for (const auto& make :
             {cornell, plates, five_lights, idol, ajar, ring, lanterns, terrace}) {
            const Scene scene = make();
            check_scene(scene);
            std::size_t triangles = 0;
            for (const Object& object : scene.objects)
                triangles += scene.geometries[object.geometry].mesh.triangles.size();
            std::printf("%zu objects, %zu triangles, ", scene.objects.size(), triangles);
            write_file(folder + "/" + scene.name + ".glb", glb_bytes(scene));
        }
        write_file(folder + "/terrace_sky.hdr", terrace_sky());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "midway-assets: error: %s\n", error.what());
        return 1;
    }
    return 0;
}
