#include <cmath>
#include <string>

#include "scenes.h"

namespace midway::assets {
namespace {

constexpr double half_width = 3.6, back = -6.0, wall_height = 3.4;

struct Palette {
    std::vector<int> paper, bulb;  // materials, brightest first
};

// Six tints at brightnesses that span four decades: some lamps have all but gone out.
Palette add_lamps(Scene& scene) {
    const dvec3 tints[] = {{1.0, 0.45, 0.10}, {1.0, 0.12, 0.05},  {1.0, 0.72, 0.38},
                           {1.0, 0.22, 0.50}, {0.16, 0.95, 0.40}, {0.15, 0.42, 1.0}};
    Palette palette;
    for (const double strength : {4.0, 1.2, 0.3, 0.05, 0.004})
        for (const dvec3& tint : tints)
            palette.paper.push_back(add_material(scene, lamp("paper", tint * strength)));
    for (const double strength : {1800.0, 300.0, 20.0, 1.0})
        palette.bulb.push_back(
            add_material(scene, lamp("bulb", dvec3(1.0, 0.78, 0.48) * strength)));
    return palette;
}

struct LampShapes {
    int round = 0, box = 0, bulb = 0, cable = 0;
    Palette palette;
};

// A cable sags between two hooks; lamps of either kind hang along it.
void add_string(Scene& scene, const LampShapes& shapes, const dvec3& from, const dvec3& to,
                bool with_bulbs, Random& random) {
    const double sag = random.between(0.35, 0.6);
    const auto at = [&](double t) {
        return glm::mix(from, to, t) - dvec3(0, 4 * sag * t * (1 - t), 0);
    };
    std::vector<dvec3> curve;
    for (int i = 0; i <= 24; ++i) curve.push_back(at(i / 24.0));
    const std::string name =
        "string " + std::to_string(int(from.z * 100)) + (with_bulbs ? "b" : "p");
    show_solid(scene, name, shapes.cable, tube(curve, 0.004, 5));

    const int count = with_bulbs ? 34 : 13;
    for (int i = 0; i < count; ++i) {
        const dvec3 hook = at((i + 0.5) / count);
        const std::string lamp_name = name + " lamp " + std::to_string(i);
        if (with_bulbs) {
            const int bulb = shapes.palette.bulb[random.below(int(shapes.palette.bulb.size()))];
            place(scene, lamp_name, shapes.bulb, bulb, translation(hook - dvec3(0, 0.018, 0)));
            continue;
        }
        // Half of the lamps are of the two bright kinds.
        const int brightness = random.next() < 0.55 ? random.below(2) : 2 + random.below(3);
        const int paper = shapes.palette.paper[brightness * 6 + random.below(6)];
        const double size = random.between(0.75, 1.35);
        const bool is_round = random.next() < 0.7;
        const double drop = (is_round ? 0.085 : 0.095) * size + 0.01;
        place(scene, lamp_name, is_round ? shapes.round : shapes.box, paper,
              translation(hook - dvec3(0, drop, 0)) * rotation({0, 1, 0}, random.between(0, 90)) *
                  scaling(dvec3(size)));
    }
}

void add_strings(Scene& scene, const LampShapes& shapes) {
    Random random{8};
    for (int i = 0; i < 9; ++i) {
        const double z = back + 0.5 + 0.85 * i;
        const double lift = random.between(-0.25, 0.1);
        const double slant = random.between(-0.5, 0.5);
        add_string(scene, shapes, {-half_width, wall_height - 0.25 + lift, z},
                   {half_width, wall_height - 0.15 - lift, z + slant}, false, random);
        if (i % 2 == 0) continue;
        add_string(scene, shapes, {-half_width, wall_height - 0.7, z + 0.3},
                   {half_width, wall_height - 0.7, z - slant}, true, random);
    }
}

// Lamps on the ground, and small ones afloat in the basin.
void add_standing_lamps(Scene& scene, const LampShapes& shapes) {
    const dvec3 ground[] = {{-1.75, 0, -1.1}, {-1.35, 0, -1.45}, {1.75, 0, -0.6}, {1.15, 0, -5.4}};
    for (int i = 0; i < 4; ++i)
        place(scene, "standing lamp " + std::to_string(i), shapes.box, shapes.palette.paper[6 + i],
              translation(ground[i] + dvec3(0, 0.1805, 0)) * rotation({0, 1, 0}, 25.0 * i) *
                  scaling(dvec3(1.9, 2.1, 1.9)));
    const dvec2 water[] = {{-0.3, 0.25}, {0.15, 0.4}, {0.45, -0.1}, {-0.1, -0.4}, {0.2, -0.05}};
    for (int i = 0; i < 5; ++i)
        place(scene, "floating lamp " + std::to_string(i), shapes.box, shapes.palette.paper[i],
              translation({0.35 + water[i].x, 0.381, -2.2 + water[i].y}) *
                  rotation({0, 1, 0}, 31.0 * i) * scaling(dvec3(0.55, 0.45, 0.55)));
}

void add_courtyard(Scene& scene) {
    const double w = half_width, h = wall_height, f = 5.5;
    const int plaster = add_material(scene, lambert("plaster", {0.68, 0.57, 0.45}));
    const int brick = add_material(scene, lambert("brick", {0.44, 0.22, 0.15}));
    const int stone = add_material(scene, glossy("wet stone", {0.17, 0.16, 0.16}, 0.22));
    const int wood = add_material(scene, glossy("painted wood", {0.10, 0.22, 0.20}, 0.3));
    show_surface(scene, "ground", stone, quad({-w, 0, f}, {w, 0, f}, {w, 0, back}, {-w, 0, back}));
    show_surface(scene, "back wall", plaster,
                 quad({-w, 0, back}, {w, 0, back}, {w, h + 0.6, back}, {-w, h + 0.6, back}));
    show_surface(scene, "left wall", brick,
                 quad({-w, 0, f}, {-w, 0, back}, {-w, h, back}, {-w, h, f}));
    show_surface(scene, "right wall", plaster,
                 quad({w, 0, back}, {w, 0, f}, {w, h, f}, {w, h, back}));
    show_solid(scene, "gate", wood, box({-0.85, 0, back - 0.05}, {0.85, 2.3, back + 0.06}));
    const int column = add_solid(scene, "column",
                                 lathe({{0, 0},
                                        {0.21, 0},
                                        {0.21, 0},
                                        {0.21, 0.16},
                                        {0.21, 0.16},
                                        {0.15, 0.22},
                                        {0.15, 0.22},
                                        {0.125, 2.1},
                                        {0.125, 2.1},
                                        {0.2, 2.24},
                                        {0.2, 2.24},
                                        {0.2, 2.4},
                                        {0.2, 2.4},
                                        {0, 2.4}},
                                       40));
    for (int i = 0; i < 4; ++i)
        for (const double side : {-1.0, 1.0})
            place(scene, "column", column, plaster,
                  translation({side * (w - 0.35), 0, back + 0.8 + 2.1 * i}));
    show_solid(scene, "left beam", wood, box({-w + 0.2, 2.4, back}, {-w + 0.5, 2.55, f - 1}));
    show_solid(scene, "right beam", wood, box({w - 0.5, 2.4, back}, {w - 0.2, 2.55, f - 1}));
    place(scene, "bench", add_solid(scene, "bench", rounded_box({0.9, 0.04, 0.2}, 0.015, 3)), wood,
          translation({-2.45, 0.45, -2.2}) * rotation({0, 1, 0}, 80));
    const int block = add_solid(scene, "block", box({-0.06, 0, -0.17}, {0.06, 0.409, 0.17}));
    for (const double along : {-0.7, 0.7})
        place(scene, "bench foot", block, plaster,
              translation({-2.45, 0, -2.2}) * rotation({0, 1, 0}, 80) * translation({along, 0, 0}));
}

// A round basin, its still water nearly a mirror, and a polished bronze jar beside it.
void add_basin(Scene& scene) {
    const int rim = add_material(scene, lambert("basin", {0.55, 0.52, 0.48}));
    const int water = add_material(scene, glossy("water", {0.01, 0.015, 0.02}, 0.05));
    const int bronze = add_material(scene, metal("bronze", {0.80, 0.56, 0.36}, 0.18));
    place(scene, "basin",
          add_solid(scene, "basin",
                    lathe({{0.95, 0},
                           {0.95, 0},
                           {0.95, 0.36},
                           {0.95, 0.36},
                           {1.0, 0.36},
                           {1.0, 0.36},
                           {1.0, 0.42},
                           {1.0, 0.42},
                           {0.82, 0.42},
                           {0.82, 0.42},
                           {0.82, 0},
                           {0.82, 0}},
                          96, true)),
          rim, translation({0.35, 0, -2.2}));
    place(scene, "water", add_surface(scene, "water", lathe({{0.825, 0.34}, {0, 0.34}}, 64)), water,
          translation({0.35, 0, -2.2}));
    std::vector<dvec2> profile = {{0, 0}};
    for (int i = 0; i <= 40; ++i) {
        const double t = i / 40.0;
        const double r = 0.17 + 0.20 * std::sin(pi * std::pow(t, 0.8)) - 0.05 * t;
        profile.push_back({r, 0.9 * t});
        if (i == 0 || i == 40) profile.push_back({r, 0.9 * t});
    }
    profile.push_back({0.16, 0.94});
    profile.push_back({0.16, 0.94});
    profile.push_back({0, 0.94});
    place(scene, "jar", add_solid(scene, "jar", lathe(profile, 72)), bronze,
          translation({2.15, 0, -1.6}));
}

}  // namespace

Scene lanterns() {
    Scene scene{.name = "lanterns"};
    add_courtyard(scene);
    add_basin(scene);
    LampShapes shapes;
    shapes.palette = add_lamps(scene);
    shapes.cable = add_material(scene, lambert("cable", dvec3(0.03)));
    shapes.round =
        add_solid(scene, "round lantern", transformed(icosphere(0.085, 1), scaling({1, 0.85, 1})));
    shapes.box = add_solid(scene, "box lantern", box({-0.06, -0.085, -0.06}, {0.06, 0.085, 0.06}));
    shapes.bulb = add_solid(scene, "bulb", icosphere(0.012, 0));
    add_strings(scene, shapes);
    add_standing_lamps(scene, shapes);
    scene.cameras.push_back({.name = "camera",
                             .yfov = 40 * pi / 180,
                             .aspect_ratio = 16.0 / 9.0,
                             .to_world = looking_at({-0.5, 1.55, 4.4}, {0.15, 1.45, -2})});
    return scene;
}

}  // namespace midway::assets
