// Size: lamps and objects far smaller and far larger than the scene, and meshes that no one would
// make on purpose.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "report/extreme_groups.h"
#include "report/extreme_measure.h"
#include "report/extreme_scenes.h"

namespace midway::extreme {
namespace {

constexpr double pi_d = std::numbers::pi;
constexpr float albedo = 0.7f;

// Sees nothing but the floor, from below the lamp.
CameraDescription floor_camera() { return camera_at({0.15f, 0.3f, 0.45f}, {0, 0, 0}, 0.25); }

Setup floor_setup(const std::string& name, RenderSettings settings) {
    Setup s{name, {}, floor_camera(), std::move(settings)};
    add(s.scene, make_quad({-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}), lambert(vec3(albedo)));
    return s;
}

RenderSettings bdpt(double exponent, int size, int max_bounces) {
    RenderSettings s = settings(Technique::bdpt, size, max_bounces);
    s.exponents = {exponent};
    return s;
}

// A lamp of radius r at height h sends pi a^2 L to an element of the floor at distance a by the
// view factor (1 - (1 + H^2 - R^2) / sqrt(Z^2 - 4 R^2)) / 2, H = h / a, R = r / a, Z = 1 + H^2 +
// R^2 (Siegel & Howell, Thermal Radiation Heat Transfer), here without the division by a.
double disc_view_factor(double r, double h, double a2) {
    const double z = a2 + h * h + r * r, root = std::sqrt(z * z - 4 * r * r * a2);
    // Since root^2 - (a^2 + h^2 - r^2)^2 = 4 r^2 h^2, nothing need cancel for small r.
    return 2 * r * r * h * h / (root * (root + a2 + h * h - r * r));
}

CaseResult area_lights(const CaseContext& context) {
    constexpr double h = 0.4;
    const double radii[] = {1e-7, 1e-5, 1e-3, 0.1, 1, 10};
    Judge judge(context, 12);
    for (const double r : radii)
        for (const double exponent : {1.0, 2.0}) {
            Setup s = floor_setup(fmt::format("lamp of radius {:g}", r), bdpt(exponent, 8, 1));
            const double radiance = std::max(1.0, 0.05 / (r * r));
            add(s.scene, make_disc({0, float(h), 0}, {0, -1, 0}, float(r)),
                lamp(vec3(float(radiance))));
            const double expected = mean_over_floor(s, [&](const dvec3& p) {
                return albedo * radiance * disc_view_factor(r, h, p.x * p.x + p.z * p.z);
            });
            judge.known(fmt::format("radius {:g}, {}", r, label(s.settings)),
                        mean_over_seeds(s, context, {64, 24}), expected, 3e-4);
        }
    return judge.result();
}

CaseResult lamp_of_many_triangles(const CaseContext& context) {
    const auto with = [](int n, Technique technique) {
        Setup s =
            floor_setup(fmt::format("lamp of {} triangles", 2 * n * n), settings(technique, 8, 3));
        add(s.scene, make_quad({-0.2f, 0.4f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, n),
            lamp(vec3(2), vec3(0.5f)));
        return s;
    };
    Judge judge(context, 6);
    for (const Technique technique : {Technique::path, Technique::light, Technique::bdpt}) {
        const Effort effort{technique == Technique::light ? 2048u : 64u, 24};
        const RunningMean two = mean_over_seeds(with(1, technique), context, effort);
        for (const int n : {10, 316}) {
            Setup s = with(n, technique);
            s.settings.seed = 7;
            judge.equal(fmt::format("{} triangles, {}", 2 * n * n, label(s.settings)),
                        mean_over_seeds(s, context, effort), two);
        }
    }
    return judge.result();
}

// The rectangle from (x0, z0) to (x1, z1) at height y as it should not be: cut into slivers of a
// millionth of its width beside the rest, with zero-area triangles along, and everything twice.
Mesh broken_floor(float y) {
    Mesh m;
    const float cuts[] = {-0.5f, -0.5f + 1e-6f, -0.1f, -0.1f + 1e-6f, 0.2f, 0.5f - 1e-6f, 0.5f};
    for (const float x : cuts) {
        m.positions.emplace_back(x, y, 0.5f);
        m.positions.emplace_back(x, y, -0.5f);
    }
    for (unsigned i = 0; i + 1 < std::size(cuts); ++i) {
        const unsigned a = 2 * i, b = a + 1, c = a + 2, d = a + 3;
        for (int copy = 0; copy < 2; ++copy)
            m.triangles.insert(m.triangles.end(), {{a, c, d}, {a, d, b}});
        m.triangles.insert(m.triangles.end(), {{a, a, b}, {a, b, a}, {c, c, c}});
    }
    return m;
}

CaseResult broken_meshes(const CaseContext& context) {
    Judge judge(context, 4);
    for (const Technique technique : {Technique::path, Technique::bdpt})
        for (const bool lamp_too : {false, true}) {
            const auto setup = [&](bool broken) {
                Setup s{broken ? "broken" : "whole", {}, floor_camera(), settings(technique, 8, 3)};
                const auto plane = [&](float y, bool bad) {
                    return bad ? broken_floor(y)
                               : make_quad({-0.5f, y, 0.5f}, {1, 0, 0}, {0, 0, -1});
                };
                add(s.scene, plane(0, broken), lambert(vec3(albedo)));
                // Turned over: it looks down on the floor from behind the camera.
                dmat4 over(1.0);
                over[1][1] = over[2][2] = -1;
                over[3] = {0, 1.2, 0, 1};
                add(s.scene, plane(0, broken && lamp_too), lamp(vec3(1), vec3(0.5f)), over);
                return s;
            };
            Setup broken = setup(true);
            broken.settings.seed = 3;
            judge.equal(
                fmt::format("{}, {}", lamp_too ? "lamp too" : "floor", label(broken.settings)),
                mean_over_seeds(broken, context, {64, 24}),
                mean_over_seeds(setup(false), context, {64, 24}), 1e-5);
        }
    return judge.result();
}

// A wall a hundred-thousandth of the scene in front of one that glows: nothing comes through, and
// the wall in front looks as it does alone.
CaseResult walls_close_together(const CaseContext& context) {
    Judge judge(context, 3);
    for (const Technique technique : {Technique::path, Technique::light, Technique::bdpt}) {
        const auto setup = [&](bool lit, bool hidden) {
            Setup s = floor_setup("walls 1e-5 apart", settings(technique, 8, 3));
            // What came through would light a ceiling.
            if (hidden && !lit)
                add(s.scene, make_quad({-0.5f, 0.4f, -0.5f}, {1, 0, 0}, {0, 0, 1}),
                    lambert(vec3(0.9f)));
            if (hidden)
                add(s.scene, make_quad({-0.4f, -1e-5f, 0.4f}, {0.8f, 0, 0}, {0, 0, -0.8f}),
                    lamp(vec3(100), vec3(0.5f)));
            if (lit)
                add(s.scene, make_quad({-0.2f, 0.4f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}),
                    lamp(vec3(2)));
            return s;
        };
        const Effort effort{technique == Technique::light ? 2048u : 64u, 24};
        judge.holds("nothing comes through, " + label(setup(false, true).settings),
                    mean_over_seeds(setup(false, true), context, {256, 4}).mean == 0);
        Setup both = setup(true, true);
        // Most light subpaths start between the walls; those of next event alone must do.
        both.settings.families = Families{true, true, false, false};
        if (technique == Technique::path) {
            judge.equal("the wall in front", mean_over_seeds(both, context, effort),
                        mean_over_seeds(setup(true, false), context, effort));
            continue;
        }
        both = setup(true, false);
        both.settings.seed = 5;
        add(both.scene, make_quad({-0.4f, -1e-5f, 0.4f}, {0.8f, 0, 0}, {0, 0, -0.8f}),
            lambert(vec3(0.9f)));
        judge.equal("the wall in front, " + label(both.settings),
                    mean_over_seeds(both, context, effort),
                    mean_over_seeds(setup(true, false), context, effort));
    }
    return judge.result();
}

// A ball of albedo 1/2 inside of a glowing sphere shows half of its radiance, whatever the sizes.
Setup ball_in_sphere(float ball, float sphere, const vec3& at, Technique technique) {
    Setup s{fmt::format("ball of {:g} in a sphere of {:g}", ball, sphere),
            {},
            camera_at(at + vec3(0, 0, 4 * ball), at, 0.2),
            settings(technique, 8, 4)};
    add(s.scene, make_icosphere(vec3(0), sphere, 2, true), lamp(vec3(1)));
    dmat4 place(1.0);
    place[3] = dvec4(dvec3(at), 1);
    add(s.scene, make_icosphere(vec3(0), ball, 2), lambert(vec3(0.5f)), place);
    return s;
}

CaseResult small_in_large(const CaseContext& context) {
    Judge judge(context, 2);
    for (const Technique technique : {Technique::path, Technique::bdpt}) {
        const Setup exact = ball_in_sphere(1e-3f, 1e3f, vec3(0), technique);
        judge.known(exact.name + ", " + label(exact.settings),
                    mean_over_seeds(exact, context, {64, 24}), 0.5, 1e-4);
        // Render() throws where a sample is not finite.
        const Setup finite = ball_in_sphere(1e-6f, 1e6f, vec3(0), technique);
        const double mean = mean_over_seeds(finite, context, {64, 2}).mean;
        judge.holds(finite.name + " is finite", mean >= 0 && mean <= 1.01);
    }
    return judge.result();
}

}  // namespace

std::vector<ExtremeCase> size_cases() {
    return {
        {"size", "area_lights",
         "lamps of radius 1e-7 to 10 times the scene light a floor by the view factor of a disc",
         false, area_lights},
        {"size", "lamp_of_many_triangles",
         "one lamp as 2, 200 and 200,000 triangles gives one image", false, lamp_of_many_triangles},
        {"size", "broken_meshes",
         "slivers, zero-area and duplicate triangles change nothing, in floors and in lamps", false,
         broken_meshes},
        {"size", "walls_close_together",
         "a lamp 1e-5 of the scene behind a wall is not seen, and the wall looks as it does alone",
         false, walls_close_together},
        {"size", "small_in_large",
         "a ball of 1e-3 in a glowing sphere of 1e3 shows its albedo; 1e-6 in 1e6 is finite", true,
         small_in_large}};
}

}  // namespace midway::extreme
