// After figure 2 of Veach and Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo
// Rendering": lamps of one power and four sizes, mirrored in plates of four roughnesses.
#include <cmath>
#include <string>

#include "scenes.h"

namespace midway::assets {
namespace {

constexpr dvec3 eye{0, 1.25, 4.6};
constexpr dvec3 lamp_row{0, 1.62, -0.55};

// Turns a plate about x so that it mirrors the row of lamps into the camera.
dmat4 facing_lamps(const dvec3& centre) {
    const dvec3 half_way =
        glm::normalize(glm::normalize(eye - centre) + glm::normalize(lamp_row - centre));
    return translation(centre) * rotation({1, 0, 0}, std::atan2(half_way.z, half_way.y) * 180 / pi);
}

}  // namespace

Scene plates() {
    Scene scene{.name = "plates"};
    const int wall = add_material(scene, lambert("wall", {0.40, 0.40, 0.42}));
    show_surface(scene, "floor", wall, quad({-4, 0, 3}, {4, 0, 3}, {4, 0, -1.5}, {-4, 0, -1.5}));
    show_surface(scene, "back wall", wall,
                 quad({-4, 0, -1.5}, {4, 0, -1.5}, {4, 4, -1.5}, {-4, 4, -1.5}));

    const int plate = add_solid(scene, "plate", rounded_box({1.55, 0.012, 0.20}, 0.005, 3));
    const double roughness[] = {0.07, 0.14, 0.22, 0.32};
    const dvec3 centres[] = {{0, 0.98, -0.62}, {0, 0.62, -0.32}, {0, 0.34, 0.08}, {0, 0.13, 0.58}};
    for (int i = 0; i < 4; ++i) {
        const std::string name = "plate " + std::to_string(i + 1);
        const int steel = add_material(scene, metal(name, {0.62, 0.64, 0.66}, roughness[i]));
        place(scene, name, plate, steel, facing_lamps(centres[i]));
    }

    const double intensity = 0.40;  // per steradian, of every lamp: radiance times cross-section
    const double radii[] = {0.008, 0.027, 0.09, 0.27};
    const double across[] = {-1.2, -0.5, 0.22, 1.08};
    for (int i = 0; i < 4; ++i) {
        const std::string name = "lamp " + std::to_string(i + 1);
        const dvec3 radiance(intensity / (pi * radii[i] * radii[i]));
        const int bulb = add_material(scene, lamp(name, radiance));
        place(scene, name, add_solid(scene, name, icosphere(radii[i], 3)), bulb,
              translation({across[i], lamp_row.y, lamp_row.z}));
    }
    scene.lights.push_back({.name = "fill",
                            .kind = LightKind::point,
                            .intensity = dvec3(1.6),
                            .to_world = translation({0, 3.5, 4})});
    scene.cameras.push_back({.name = "camera",
                             .yfov = 30 * pi / 180,
                             .aspect_ratio = 4.0 / 3.0,
                             .to_world = looking_at(eye, {0, 0.90, 0})});
    return scene;
}

}  // namespace midway::assets
