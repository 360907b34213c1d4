// The Cornell box as measured: Cornell University Program of Computer Graphics, "Cornell Box Data"
// (1998), in millimetres there, metres here. Reflectances and lamp are the usual RGB stand-ins for
// the measured spectra. The lamp fills a hole in the ceiling.
#include <array>
#include <cmath>

#include "scenes.h"

namespace midway::assets {
namespace {

Mesh measured(std::initializer_list<std::array<dvec3, 4>> faces) {
    Mesh mesh;
    for (const auto& f : faces)
        append(mesh, quad(f[0] * 1e-3, f[1] * 1e-3, f[2] * 1e-3, f[3] * 1e-3));
    return mesh;
}

Mesh ceiling_around_lamp() {
    const double h = 548.8;
    return measured({{{{556, h, 0}, {556, h, 559.2}, {343, h, 559.2}, {343, h, 0}}},
                     {{{213, h, 0}, {213, h, 559.2}, {0, h, 559.2}, {0, h, 0}}},
                     {{{343, h, 0}, {343, h, 227}, {213, h, 227}, {213, h, 0}}},
                     {{{343, h, 332}, {343, h, 559.2}, {213, h, 559.2}, {213, h, 332}}}});
}

Mesh short_block() {
    return measured({{{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
                     {{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
                     {{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
                     {{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
                     {{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}}});
}

Mesh tall_block() {
    return measured({{{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
                     {{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
                     {{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
                     {{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
                     {{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}}});
}

}  // namespace

Scene cornell() {
    Scene scene{.name = "cornell"};
    const int white = add_material(scene, lambert("white", {0.725, 0.71, 0.68}));
    const int red = add_material(scene, lambert("red", {0.63, 0.065, 0.05}));
    const int green = add_material(scene, lambert("green", {0.14, 0.45, 0.091}));
    const int light = add_material(scene, lamp("light", {18.4, 15.6, 8.0}));
    const double h = 548.8;
    show_surface(scene, "floor", white,
                 measured({{{{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}}}}));
    show_surface(scene, "ceiling", white, ceiling_around_lamp());
    show_surface(scene, "back wall", white,
                 measured({{{{549.6, 0, 559.2}, {0, 0, 559.2}, {0, h, 559.2}, {556, h, 559.2}}}}));
    show_surface(scene, "right wall", green,
                 measured({{{{0, 0, 559.2}, {0, 0, 0}, {0, h, 0}, {0, h, 559.2}}}}));
    show_surface(scene, "left wall", red,
                 measured({{{{552.8, 0, 0}, {549.6, 0, 559.2}, {556, h, 559.2}, {556, h, 0}}}}));
    show_surface(scene, "short block", white, short_block());
    show_surface(scene, "tall block", white, tall_block());
    show_surface(scene, "light", light,
                 measured({{{{343, h, 227}, {343, h, 332}, {213, h, 332}, {213, h, 227}}}}));
    scene.cameras.push_back({.name = "camera",
                             .yfov = 2 * std::atan(0.0125 / 0.035),
                             .to_world = looking_at({0.278, 0.273, -0.8}, {0.278, 0.273, 0})});
    return scene;
}

}  // namespace midway::assets
