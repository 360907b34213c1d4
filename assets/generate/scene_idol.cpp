#include <cmath>

#include "figures.h"
#include "scenes.h"

namespace midway::assets {
namespace {

constexpr double room_half_width = 1.5, room_height = 2.4, room_front = 2.6, room_back = -1.3;
constexpr double stage_height = 0.16;

// A wall of upright flutes: seen through the glass its lines bend and show the shape of the head.
Mesh fluted_wall(double half_width, double height, double z) {
    const int steps = 240;
    const double flutes = 15, depth = 0.027;
    Mesh mesh;
    for (int i = 0; i <= steps; ++i) {
        const double x = half_width * (2.0 * i / steps - 1);
        const double phase = pi * flutes * x / half_width;
        const double slope = -depth * std::sin(phase) * pi * flutes / half_width;
        for (const double y : {0.0, height}) {
            mesh.positions.push_back({x, y, z + depth * (std::cos(phase) + 1)});
            mesh.normals.push_back(glm::normalize(dvec3(-slope, 0, 1)));
        }
        if (i == 0) continue;
        const std::uint32_t a = 2 * (i - 1);
        mesh.triangles.insert(mesh.triangles.end(), {{a, a + 2, a + 3}, {a, a + 3, a + 1}});
    }
    return mesh;
}

void add_room(Scene& scene) {
    const double w = room_half_width, h = room_height, f = room_front, b = room_back;
    const int pale = add_material(scene, lambert("plaster", {0.62, 0.60, 0.57}));
    const int dark = add_material(scene, lambert("back wall", {0.20, 0.32, 0.36}));
    const int floor = add_material(scene, lambert("floor", {0.42, 0.36, 0.31}));
    const int warm = add_material(scene, lambert("left wall", {0.62, 0.28, 0.17}));
    const int cool = add_material(scene, lambert("right wall", {0.16, 0.34, 0.42}));
    const auto wall = [&](const char* name, int material, const Mesh& mesh) {
        show_surface(scene, name, material, mesh);
    };
    wall("floor", floor, quad({-w, 0, f}, {w, 0, f}, {w, 0, b}, {-w, 0, b}));
    wall("ceiling", pale, quad({-w, h, b}, {w, h, b}, {w, h, f}, {-w, h, f}));
    wall("back wall", dark, fluted_wall(w, h, b));
    wall("front wall", pale, quad({w, 0, f}, {-w, 0, f}, {-w, h, f}, {w, h, f}));
    wall("left wall", warm, quad({-w, 0, f}, {-w, 0, b}, {-w, h, b}, {-w, h, f}));
    wall("right wall", cool, quad({w, 0, b}, {w, 0, f}, {w, h, f}, {w, h, b}));
}

}  // namespace

Scene idol() {
    Scene scene{.name = "idol"};
    add_room(scene);

    const int stone = add_material(scene, lambert("stage", {0.74, 0.71, 0.66}));
    show_solid(scene, "stage", stone, cylinder(0.62, stage_height, 0.02, 128));

    // Not in touch with the stage: two surfaces in one place would leave it open which is met
    // first.
    const double size = 0.25, gap = 0.0005;
    const int clear = add_material(scene, glass("idol glass", 1.5));
    place(scene, "idol",
          add_solid(scene, "idol", transformed(idol_head(0.036), scaling(dvec3(size)))), clear,
          translation({0, stage_height + gap, 0}) * rotation({0, 1, 0}, -12));

    const dvec3 lamp_position(0.70, 1.80, -0.85);
    const int bulb = add_material(scene, lamp("lamp", dvec3(1.0, 0.90, 0.76) * 2300.0));
    place(scene, "lamp", add_solid(scene, "lamp", icosphere(0.03, 2)), bulb,
          translation(lamp_position));

    scene.cameras.push_back({.name = "camera",
                             .yfov = 30 * pi / 180,
                             .aspect_ratio = 1,
                             .to_world = looking_at({-0.20, 0.76, 2.20}, {-0.04, 0.40, 0.05})});
    return scene;
}

}  // namespace midway::assets
