// A room that only the slit of a door lights, in the spirit of Veach's door ajar (Veach and Guibas
// 1997, "Metropolis Light Transport").
#include <string>

#include "figures.h"
#include "scenes.h"

namespace midway::assets {
namespace {

constexpr double half_width = 2.0, height = 2.5, front = 2.6, divide = -1.6, back = -3.3;
constexpr double wall_thickness = 0.12, door_left = 0.30, door_right = 1.20, door_height = 2.02;
constexpr double table_top = 0.74;

void add_shell(Scene& scene) {
    const double w = half_width, h = height, f = front, b = back;
    const int plaster = add_material(scene, lambert("plaster", {0.74, 0.71, 0.65}));
    const int blue = add_material(scene, lambert("left wall", {0.30, 0.40, 0.52}));
    const int light_tile = add_material(scene, lambert("light tile", {0.62, 0.58, 0.50}));
    const int dark_tile = add_material(scene, lambert("dark tile", {0.20, 0.16, 0.13}));
    for (const bool odd : {false, true})
        show_surface(scene, odd ? "dark tiles" : "light tiles", odd ? dark_tile : light_tile,
                     checker_half({-w, b}, {w, f}, 10, 15, odd));
    show_surface(scene, "ceiling", plaster, quad({-w, h, b}, {w, h, b}, {w, h, f}, {-w, h, f}));
    show_surface(scene, "corridor wall", plaster,
                 quad({-w, 0, b}, {w, 0, b}, {w, h, b}, {-w, h, b}));
    show_surface(scene, "front wall", plaster, quad({w, 0, f}, {-w, 0, f}, {-w, h, f}, {w, h, f}));
    show_surface(scene, "left wall", blue, quad({-w, 0, f}, {-w, 0, b}, {-w, h, b}, {-w, h, f}));
    show_surface(scene, "right wall", plaster, quad({w, 0, b}, {w, 0, f}, {w, h, f}, {w, h, b}));

    // The wall with the doorway reaches a little beyond its neighbours, so that no light leaks.
    const double e = 0.05, z0 = divide - wall_thickness, z1 = divide;
    Mesh wall = box({-w - e, -e, z0}, {door_left, h + e, z1});
    append(wall, box({door_right, -e, z0}, {w + e, h + e, z1}));
    append(wall, box({door_left - e, door_height, z0 + 1e-4}, {door_right + e, h + e, z1 - 1e-4}));
    show_surface(scene, "wall with doorway", plaster, wall);
}

void add_door(Scene& scene) {
    const int wood = add_material(scene, glossy("door", {0.36, 0.20, 0.10}, 0.35));
    const int brass = add_material(scene, metal("brass", {0.89, 0.74, 0.42}, 0.2));
    const double width = door_right - door_left - 0.01;
    const dmat4 hinge = translation({door_right - 0.005, 0, divide}) * rotation({0, 1, 0}, 28);
    place(scene, "door",
          add_solid(scene, "door",
                    transformed(rounded_box({width / 2, door_height / 2 - 0.008, 0.02}, 0.004, 2),
                                translation({-width / 2, door_height / 2, -0.02}))),
          wood, hinge);
    place(scene, "door knob", add_solid(scene, "door knob", icosphere(0.032, 3)), brass,
          hinge * translation({-width + 0.07, 1.0, 0.045}));
    // Frame around the doorway, on the room's side; it stands out a millimetre from the wall.
    const double a = door_left + 1e-3, b = door_right - 1e-3, h = door_height - 1e-3, z = divide;
    const int paint = add_material(scene, lambert("door frame", {0.52, 0.50, 0.46}));
    show_solid(scene, "left post", paint, box({a - 0.08, 0, z - 0.01}, {a, h + 0.08, z + 0.025}));
    show_solid(scene, "right post", paint, box({b, 0, z - 0.01}, {b + 0.08, h + 0.08, z + 0.025}));
    show_solid(scene, "lintel", paint, box({a, h, z - 0.01}, {b, h + 0.08, z + 0.025}));
}

void add_table(Scene& scene) {
    const int wood = add_material(scene, lambert("table", {0.56, 0.40, 0.25}));
    const dvec3 centre(-0.15, 0, 0.35);
    place(scene, "table top",
          add_solid(scene, "table top", rounded_box({0.75, 0.02, 0.42}, 0.01, 3)), wood,
          translation(centre + dvec3(0, table_top - 0.02, 0)));
    const int leg =
        add_solid(scene, "leg", rounded_box({0.03, (table_top - 0.042) / 2, 0.03}, 0.005, 2));
    int number = 0;
    for (const double x : {-0.68, 0.68})
        for (const double z : {-0.35, 0.35})
            place(scene, "leg " + std::to_string(++number), leg, wood,
                  translation(centre + dvec3(x, (table_top - 0.042) / 2, z)));

    const int clear = add_material(scene, glass("glass", 1.5));
    const int mirror = add_material(scene, metal("mirror", {0.95, 0.95, 0.95}, 0));
    const int steel = add_material(scene, metal("rough steel", {0.66, 0.62, 0.58}, 0.35));
    const int clay = add_material(scene, lambert("clay", {0.60, 0.26, 0.17}));
    const double y = table_top + 0.0005;
    place(scene, "glass teapot",
          add_solid(scene, "glass teapot", transformed(teapot(0.024), scaling(dvec3(0.27)))), clear,
          translation({-0.32, y, 0.36}) * rotation({0, 1, 0}, 25));
    place(scene, "mirror ball", add_solid(scene, "mirror ball", icosphere(0.105, 5)), mirror,
          translation({0.18, y + 0.105, 0.22}));
    place(scene, "rough ball", add_solid(scene, "rough ball", icosphere(0.08, 4)), steel,
          translation({-0.70, y + 0.08, 0.20}));
    place(scene, "cup",
          add_solid(scene, "cup",
                    lathe({{0, 0},
                           {0.045, 0},
                           {0.045, 0},
                           {0.052, 0.09},
                           {0.052, 0.09},
                           {0.047, 0.09},
                           {0.047, 0.09},
                           {0.041, 0.006},
                           {0.041, 0.006},
                           {0, 0.006}},
                          64)),
          clay, translation({0.43, y, 0.50}));
}

// A tube on the corridor's wall, closed below, with a square that shines up to the ceiling inside:
// from nowhere in the room, and from little of the corridor, can it be seen.
void add_wall_lamp(Scene& scene) {
    const double radius = 0.10, thickness = 0.008, length = 0.36, depth = 0.10;
    const dmat4 place_of_it = translation({0.85, 1.85, back + 0.16});
    const int shade = add_material(scene, lambert("shade", {0.45, 0.42, 0.38}));
    const int bulb = add_material(scene, lamp("bulb", dvec3(1.0, 0.88, 0.68) * 16000.0));
    const double inner = radius - thickness;
    place(scene, "shade",
          add_solid(scene, "shade",
                    lathe({{0, 0},
                           {radius, 0},
                           {radius, 0},
                           {radius, length},
                           {radius, length},
                           {inner, length},
                           {inner, length},
                           {inner, thickness},
                           {inner, thickness},
                           {0, thickness}},
                          64)),
          shade, place_of_it);
    const double y = length - depth, r = 0.06;
    place(scene, "bulb",
          add_surface(scene, "bulb", quad({-r, y, r}, {r, y, r}, {r, y, -r}, {-r, y, -r})), bulb,
          place_of_it);
}

}  // namespace

Scene ajar() {
    Scene scene{.name = "ajar"};
    add_shell(scene);
    add_door(scene);
    add_table(scene);
    add_wall_lamp(scene);
    scene.cameras.push_back({.name = "camera",
                             .yfov = 38 * pi / 180,
                             .aspect_ratio = 4.0 / 3.0,
                             .to_world = looking_at({-0.45, 1.30, 2.35}, {0.06, 0.90, 0})});
    return scene;
}

}  // namespace midway::assets
