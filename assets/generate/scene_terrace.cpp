#include <algorithm>
#include <cmath>
#include <string>

#include "scenes.h"
#include "terrace_sun.h"

namespace midway::assets {
namespace {

constexpr double half_width = 3.2, edge = -2.6, front = 3.4;

void add_floor(Scene& scene) {
    const int pale = add_material(scene, glossy("pale tile", {0.66, 0.58, 0.48}, 0.45));
    const int red = add_material(scene, glossy("red tile", {0.50, 0.24, 0.15}, 0.45));
    const int joint = add_material(scene, lambert("joint", {0.34, 0.31, 0.28}));
    show_surface(scene, "joints", joint,
                 quad({-half_width, -0.006, front}, {half_width, -0.006, front},
                      {half_width, -0.006, edge}, {-half_width, -0.006, edge}));
    const double pitch = 0.4;
    const int tile = add_solid(scene, "tile",
                               rounded_box({pitch / 2 - 0.006, 0.01, pitch / 2 - 0.006}, 0.004, 2));
    const int columns = int(std::lround(2 * half_width / pitch));
    const int rows = int(std::lround((front - edge) / pitch));
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            place(scene, "tile", tile, (i + j) % 2 == 0 ? pale : red,
                  translation({-half_width + (i + 0.5) * pitch, -0.01, edge + (j + 0.5) * pitch}));
}

Mesh baluster() {
    std::vector<dvec2> profile = {{0, 0}, {0.06, 0}, {0.06, 0}, {0.06, 0.05}, {0.06, 0.05}};
    for (int i = 0; i <= 32; ++i) {
        const double t = i / 32.0;
        const double belly = std::exp(-std::pow((t - 0.28) / 0.20, 2.0));
        const double collar = std::exp(-std::pow((t - 0.80) / 0.05, 2.0));
        profile.push_back({0.026 + 0.038 * belly + 0.014 * collar, 0.05 + 0.62 * t});
        if (i == 0 || i == 32) profile.push_back(profile.back());
    }
    profile.insert(profile.end(),
                   {{0.06, 0.67}, {0.06, 0.67}, {0.06, 0.72}, {0.06, 0.72}, {0, 0.72}});
    return lathe(profile, 24);
}

void add_railing(Scene& scene) {
    const int stone = add_material(scene, lambert("stone", {0.72, 0.69, 0.62}));
    const double z = edge + 0.15;
    show_solid(scene, "plinth", stone,
               box({-half_width, 0.0005, z - 0.12}, {half_width, 0.12, z + 0.12}));
    const int post = add_solid(scene, "baluster", baluster());
    for (int i = 0; i < 26; ++i)
        place(scene, "baluster", post, stone,
              translation({-half_width + 0.35 + i * (2 * half_width - 0.7) / 25, 0.1205, z}));
    place(scene, "rail", add_solid(scene, "rail", rounded_box({half_width, 0.045, 0.11}, 0.03, 4)),
          stone, translation({0, 0.12 + 0.72 + 0.046, z}));
    const int pier = add_solid(scene, "pier", rounded_box({0.16, 0.5, 0.16}, 0.012, 3));
    for (const double x : {-half_width + 0.16, half_width - 0.16})
        place(scene, "pier", pier, stone, translation({x, 0.501, z}));
}

// A blade that bends over, `length` long, standing at the origin and leaning to +z.
Mesh leaf(double length, double width, double bend) {
    const int steps = 10;
    Mesh mesh;
    dvec3 p(0);
    double angle = 0.25;  // from the vertical
    for (int i = 0; i <= steps; ++i) {
        const double t = double(i) / steps;
        const double half =
            width / 2 * std::max(std::pow(std::sin(pi * std::min(t + 0.06, 1.0)), 0.7), 0.04);
        const dvec3 along(0, std::cos(angle), std::sin(angle));
        const dvec3 normal(0, std::sin(angle), -std::cos(angle));
        for (const double side : {-1.0, 1.0}) {
            mesh.positions.push_back(p + dvec3(side * half, 0, 0) + normal * (0.25 * half));
            mesh.normals.push_back(glm::normalize(normal - dvec3(side * 0.35, 0, 0)));
        }
        mesh.positions.push_back(p);
        mesh.normals.push_back(normal);
        p += along * (length / steps);
        angle += bend / steps;
        if (i == 0) continue;
        const std::uint32_t a = 3 * (i - 1), b = 3 * i;  // left, right, middle
        mesh.triangles.insert(
            mesh.triangles.end(),
            {{a, b, a + 2}, {a + 2, b, b + 2}, {a + 2, b + 2, a + 1}, {a + 1, b + 2, b + 1}});
    }
    return mesh;
}

Mesh pot() {
    return lathe({{0, 0},
                  {0.15, 0},
                  {0.15, 0},
                  {0.21, 0.30},
                  {0.21, 0.30},
                  {0.235, 0.30},
                  {0.235, 0.30},
                  {0.24, 0.36},
                  {0.24, 0.36},
                  {0.205, 0.36},
                  {0.205, 0.36},
                  {0.195, 0.31},
                  {0.195, 0.31},
                  {0, 0.31}},
                 64);
}

void add_plants(Scene& scene) {
    const int clay = add_material(scene, lambert("terracotta", {0.58, 0.27, 0.15}));
    const int earth = add_material(scene, lambert("earth", {0.10, 0.07, 0.05}));
    const int pot_shape = add_solid(scene, "pot", pot());
    const int soil = add_surface(scene, "soil", lathe({{0.20, 0.32}, {0, 0.325}}, 48));
    std::vector<int> greens, shapes;
    for (const dvec3& green :
         {dvec3(0.10, 0.26, 0.06), dvec3(0.16, 0.34, 0.08), dvec3(0.07, 0.20, 0.07)}) {
        Material m = glossy("leaf", green, 0.4);
        m.double_sided = true;
        greens.push_back(add_material(scene, m));
    }
    for (const double bend : {0.8, 1.4, 2.0})
        shapes.push_back(add_surface(scene, "leaf", leaf(0.75, 0.075, bend)));
    Random random{11};
    const dvec3 spots[] = {{-2.45, 0.0005, -1.75}, {2.3, 0.0005, -1.5}, {2.65, 0.0005, -0.6}};
    for (const dvec3& spot : spots) {
        place(scene, "pot", pot_shape, clay, translation(spot));
        place(scene, "soil", soil, earth, translation(spot));
        const double vigour = random.between(0.8, 1.2);
        for (int i = 0; i < 46; ++i) {
            const double size = vigour * random.between(0.7, 1.2);
            place(scene, "leaf", shapes[random.below(3)], greens[random.below(3)],
                  translation(spot + dvec3(0, 0.32, 0)) *
                      rotation({0, 1, 0}, 360.0 * i / 46 + random.between(-12, 12)) *
                      translation({0, 0, random.between(0.01, 0.10)}) * scaling(dvec3(size)));
        }
    }
}

void add_chair(Scene& scene, int paint, int seat_shape, int bar, const dmat4& where) {
    place(scene, "chair seat", seat_shape, paint, where * translation({0, 0.45, 0}));
    for (const double x : {-0.18, 0.18}) {
        place(scene, "chair leg", bar, paint,
              where * translation({x, 0, 0.18}) * scaling({1, 0.43, 1}));
        place(scene, "chair leg", bar, paint,
              where * translation({x, 0, -0.18}) * scaling({1, 0.90, 1}));
    }
    for (const double y : {0.62, 0.74, 0.86})
        place(scene, "chair rail", bar, paint,
              where * translation({-0.18, y, -0.18}) * rotation({0, 0, 1}, -90) *
                  scaling({1, 0.36, 1}));
}

void add_furniture(Scene& scene) {
    const int enamel = add_material(scene, glossy("white enamel", {0.78, 0.78, 0.76}, 0.25));
    const int paint = add_material(scene, glossy("blue paint", {0.08, 0.22, 0.36}, 0.3));
    const int lemon = add_material(scene, glossy("lemon", {0.80, 0.60, 0.05}, 0.4));
    const int jug = add_material(scene, glossy("blue glaze", {0.05, 0.13, 0.38}, 0.12));
    const int steel = add_material(scene, metal("steel", {0.70, 0.70, 0.70}, 0.2));
    const dvec3 spot(0.35, 0.0005, -0.35);
    place(scene, "table top", add_solid(scene, "table top", cylinder(0.45, 0.03, 0.01, 96)), enamel,
          translation(spot + dvec3(0, 0.71, 0)));
    place(scene, "table foot",
          add_solid(scene, "table foot",
                    lathe({{0, 0},
                           {0.24, 0},
                           {0.24, 0},
                           {0.22, 0.03},
                           {0.04, 0.07},
                           {0.028, 0.2},
                           {0.028, 0.709},
                           {0.028, 0.709},
                           {0, 0.709}},
                          48)),
          steel, translation(spot));
    std::vector<dvec2> profile = {{0, 0}, {0.05, 0}, {0.05, 0}};
    for (int i = 1; i <= 30; ++i) {
        const double t = i / 30.0;
        profile.push_back({0.05 + 0.035 * std::sin(pi * t) - 0.022 * t * t, 0.24 * t});
    }
    profile.push_back(profile.back());
    profile.push_back({0, 0.24});
    const dvec3 top = spot + dvec3(0, 0.7405, 0);
    place(scene, "jug", add_solid(scene, "jug", lathe(profile, 48)), jug,
          translation(top + dvec3(-0.14, 0, -0.08)));
    const int fruit =
        add_solid(scene, "lemon", transformed(icosphere(0.034, 3), scaling({1.3, 1, 1})));
    for (const dvec2& at : {dvec2(0.10, 0.05), dvec2(0.17, 0.0), dvec2(0.13, 0.13)})
        place(scene, "lemon", fruit, lemon,
              translation(top + dvec3(at.x, 0.0345, at.y)) * rotation({0, 1, 0}, 500 * at.y + 30));
    const int seat = add_solid(scene, "chair seat", rounded_box({0.21, 0.02, 0.21}, 0.015, 3));
    const int bar = add_solid(scene, "chair bar", cylinder(0.014, 1, 0.004, 16));
    add_chair(scene, paint, seat, bar,
              translation({-0.55, 0.0005, -0.25}) * rotation({0, 1, 0}, 75));
    add_chair(scene, paint, seat, bar,
              translation({1.15, 0.0005, 0.05}) * rotation({0, 1, 0}, -110));
}

}  // namespace

Scene terrace() {
    Scene scene{.name = "terrace"};
    add_floor(scene);
    add_railing(scene);
    add_plants(scene);
    add_furniture(scene);
    const int wall = add_material(scene, lambert("house wall", {0.76, 0.72, 0.64}));
    show_solid(scene, "house wall", wall,
               box({half_width, -0.02, edge + 0.4}, {half_width + 0.3, 3.2, front}));
    scene.lights.push_back({.name = "sun",
                            .kind = LightKind::directional,
                            .intensity = dvec3(1.0, 0.90, 0.74) * 3.2,
                            .to_world = looking_at(to_terrace_sun() * 10.0, {0, 0, 0})});
    scene.cameras.push_back({.name = "camera",
                             .yfov = 36 * pi / 180,
                             .aspect_ratio = 16.0 / 9.0,
                             .to_world = looking_at({-0.35, 1.55, 3.3}, {0.15, 0.68, -0.8})});
    return scene;
}

}  // namespace midway::assets
