#include "scenes.h"

namespace midway::assets {
namespace {

void add_solids(Scene& scene) {
    const int clay = add_material(scene, lambert("clay", {0.72, 0.68, 0.62}));
    const int plastic = add_material(scene, glossy("red plastic", {0.62, 0.06, 0.05}, 0.18));
    const int copper = add_material(scene, metal("copper", {0.93, 0.62, 0.50}, 0.15));
    const int clear = add_material(scene, glass("glass", 1.5));
    const int ball = add_solid(scene, "ball", icosphere(0.24, 5));
    place(scene, "diffuse ball", ball, clay, translation({-1.05, 0.24, 0.05}));
    place(scene, "glass ball", ball, clear, translation({-0.32, 0.2405, 0.42}));
    place(scene, "plastic box", add_solid(scene, "plastic box", rounded_box(dvec3(0.21), 0.04, 6)),
          plastic, translation({0.38, 0.211, 0.10}) * rotation({0, 1, 0}, 28));
    place(scene, "copper ring", add_solid(scene, "copper ring", torus(0.23, 0.075, 96, 36)), copper,
          translation({1.12, 0.306, 0.12}) * rotation({0, 1, 0}, -25) * rotation({1, 0, 0}, 90));
    show_solid(scene, "post", clay, box({-0.40, 0, -0.95}, {-0.28, 1.1, -0.83}));
}

}  // namespace

Scene five_lights() {
    Scene scene{.name = "five-lights"};
    const int ground = add_material(scene, lambert("ground", {0.55, 0.54, 0.52}));
    show_surface(scene, "ground", ground, quad({-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}));
    add_solids(scene);

    // The lit panel, front towards the ring and the camera.
    const int panel = add_material(scene, lamp("panel", {2.4, 0.9, 1.9}));
    const int frame = add_material(scene, lambert("frame", {0.08, 0.08, 0.08}));
    const dmat4 stand = translation({1.45, 0, -0.75}) * rotation({0, 1, 0}, -20);
    place(scene, "area lamp",
          add_surface(scene, "area lamp",
                      quad({-0.30, 0.22, 0}, {0.30, 0.22, 0}, {0.30, 0.92, 0}, {-0.30, 0.92, 0})),
          panel, stand);
    place(scene, "frame", add_solid(scene, "frame", box({-0.34, 0.0, -0.06}, {0.34, 0.96, -0.005})),
          frame, stand);

    scene.lights.push_back({.name = "point lamp",
                            .kind = LightKind::point,
                            .intensity = {0.65, 0.29, 0.06},
                            .to_world = translation({-1.45, 0.40, 0.45})});
    scene.lights.push_back({.name = "spot lamp",
                            .kind = LightKind::spot,
                            .intensity = {1.4, 5.6, 5.0},
                            .inner_cone_angle = 11 * pi / 180,
                            .outer_cone_angle = 14 * pi / 180,
                            .to_world = looking_at({0.1, 2.3, 1.0}, {0.22, 0, 0.28})});
    scene.lights.push_back({.name = "directional lamp",
                            .kind = LightKind::directional,
                            .intensity = {1.3, 1.1, 0.78},
                            .to_world = looking_at({-3.0, 2.2, -2.4}, {0, 0, 0})});
    scene.cameras.push_back({.name = "camera",
                             .yfov = 30 * pi / 180,
                             .aspect_ratio = 16.0 / 9.0,
                             .to_world = looking_at({0.2, 1.45, 4.1}, {0.06, 0.34, 0})});
    return scene;
}

}  // namespace midway::assets
