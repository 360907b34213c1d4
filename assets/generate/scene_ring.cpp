#include <cmath>

#include "scenes.h"

namespace midway::assets {
namespace {

// Section of a flat band with rounded edges, walked with the outside to the right.
Mesh band(double inner_radius, double outer_radius, double height, double rounding) {
    std::vector<dvec2> profile;
    const auto corner = [&](double x, double y, double from_degrees) {
        for (int i = 0; i <= 8; ++i) {
            const double a = (from_degrees + 90.0 * i / 8) * pi / 180;
            profile.push_back(dvec2(x, y) + rounding * dvec2(std::cos(a), std::sin(a)));
        }
    };
    const double r = rounding;
    corner(outer_radius - r, r, -90);
    corner(outer_radius - r, height - r, 0);
    corner(inner_radius + r, height - r, 90);
    corner(inner_radius + r, r, 180);
    return lathe(profile, 256, true);
}

}  // namespace

Scene ring() {
    Scene scene{.name = "ring"};
    const int table = add_material(scene, lambert("table", {0.68, 0.62, 0.56}));
    const int gold = add_material(scene, metal("gold", {1.0, 0.78, 0.34}, 0.1));
    show_surface(scene, "table", table, quad({-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}));
    // Pale screens outside the frame soften the shadow and give the gold something to mirror.
    show_surface(scene, "back screen", table,
                 quad({-3, 0, -2}, {3, 0, -2}, {3, 2, -2}, {-3, 2, -2}));
    show_surface(scene, "right screen", table, quad({2, 0, -3}, {2, 0, 3}, {2, 2, 3}, {2, 2, -3}));
    place(scene, "ring", add_solid(scene, "ring", band(0.29, 0.30, 0.10, 0.004)), gold,
          translation({0, 0.0002, 0}));
    const int bulb = add_material(scene, lamp("lamp", dvec3(1.0, 0.93, 0.82) * 1900.0));
    place(scene, "lamp", add_solid(scene, "lamp", icosphere(0.02, 2)), bulb,
          translation({-0.85, 0.55, -0.48}));
    scene.cameras.push_back({.name = "camera",
                             .yfov = 34 * pi / 180,
                             .to_world = looking_at({0.12, 1.02, 0.98}, {0.02, 0.02, 0.02})});
    return scene;
}

}  // namespace midway::assets
