// Lights: a hundred thousand, none, only such as cannot be hit, skies with a spike, and the point
// lamp in a box that once gave pixels above 80,000.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "report/extreme_groups.h"
#include "report/extreme_measure.h"
#include "report/extreme_scenes.h"
#include "scene/sky.h"

namespace midway::extreme {
namespace {

constexpr double pi_d = std::numbers::pi;
constexpr float albedo = 0.5f;
constexpr Technique every_technique[] = {Technique::path, Technique::light, Technique::bdpt};

CameraDescription floor_camera() { return camera_at({0.15f, 0.6f, 0.5f}, {0, 0, 0}, 0.3); }

Setup floor_setup(const std::string& name, Technique technique) {
    Setup s{name, {}, floor_camera(), settings(technique, 8, 1)};
    add(s.scene, make_quad({-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}), lambert(vec3(albedo)));
    return s;
}

Effort effort_of(Technique technique) { return {technique == Technique::light ? 2048u : 64u, 24}; }

// Radiance of the floor at p under a point lamp of intensity 1 at q.
double under_point(const dvec3& p, const dvec3& q) {
    const dvec3 d = q - p;
    const double d2 = glm::dot(d, d);
    return albedo / pi_d * d.y / (d2 * std::sqrt(d2));
}

CaseResult hundred_thousand(const CaseContext& context) {
    constexpr int n = 316;
    std::vector<std::pair<dvec3, double>> lamps;
    for (int i = 0; i < n * n; ++i) {
        const double x = (i % n + 0.5) / n - 0.5, z = (double(i / n) + 0.5) / n - 0.5;
        lamps.push_back({{x, 0.3, z}, 1e-5 * (1 + i % 7)});
    }
    Judge judge(context, 2);
    for (const Technique technique : {Technique::path, Technique::bdpt}) {
        Setup s = floor_setup("100,000 lamps", technique);
        for (const auto& [at, intensity] : lamps)
            s.scene.lights.push_back(point_light(vec3(at), float(intensity)));
        // 16 x 16 places of the view; the sum over the lamps is smooth.
        double expected = 0;
        const Camera c = make_camera(s.camera, {}, 16, 16);
        const dvec3 eye(s.camera.to_world[3]);
        for (int i = 0; i < 256; ++i) {
            const dvec3 w(camera_direction(c, c.position, {i % 16 + 0.5f, float(i / 16) + 0.5f}));
            for (const auto& [at, intensity] : lamps)
                expected += intensity * under_point(eye - w * (eye.y / w.y), at) / 256;
        }
        judge.known(label(s.settings), mean_over_seeds(s, context, {256, 24}), expected, 1e-3);
    }
    return judge.result();
}

CaseResult only_delta(const CaseContext& context) {
    Judge judge(context, 3);
    for (const Technique technique : every_technique) {
        Setup s = floor_setup("only delta lights", technique);
        const dvec3 point(0.3, 0.5, 0), spot(-0.2, 0.7, 0.1);
        s.scene.lights = {point_light(vec3(point), 0.3f),
                          spot_light(vec3(spot), {0, 0, 0}, 0.4f, 0.9f, 1.0f),
                          sun({0.3f, -1, 0.2f}, 0.5f)};
        const double slant = 1 / std::sqrt(1 + 0.09 + 0.04);
        const double expected = mean_over_floor(s, [&](const dvec3& p) {
            return 0.3 * under_point(p, point) + 0.4 * under_point(p, spot) +
                   0.5 * slant * albedo / pi_d;
        });
        judge.known(label(s.settings), mean_over_seeds(s, context, effort_of(technique)), expected,
                    3e-4);
    }
    return judge.result();
}

// Irradiance of an upward floor from the part of a sky within `cells` of a map's cell, by
// quadrature of the interpolated map; `background` is left out.
double irradiance_about(const Sky& sky, int cx, int cy, int cells, double background) {
    constexpr int n = 64;  // points a cell, each way
    const int width = sky.map->width, height = sky.map->height;
    double sum = 0;
    for (int j = -cells * n; j < (cells + 1) * n; ++j)
        for (int i = -cells * n; i < (cells + 1) * n; ++i) {
            const double theta = pi_d * (cy + (j + 0.5) / n) / height;
            const double phi = 2 * pi_d * ((cx + (i + 0.5) / n) / width - 0.5);
            const vec3 w(float(std::sin(theta) * std::sin(phi)), float(std::cos(theta)),
                         float(-std::sin(theta) * std::cos(phi)));
            const double cell = 2 * pi_d / (width * n) * pi_d / (height * n) * std::sin(theta);
            sum += (sky_radiance(sky, w).x - background) * w.y * cell;
        }
    return sum;
}

// A sky of 0.1 in which texels about (x, y) shine with `radiance`.
Setup spiked(Technique technique, int width, int x, int y, int size, float radiance) {
    Setup s =
        floor_setup(fmt::format("sky of {} texels with {} bright", width, size * size), technique);
    auto map = std::make_shared<Image>(width, width / 2);
    map->pixels.assign(map->pixels.size(), vec3(0.1f));
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) map->at(x + i, y + j) = vec3(radiance);
    s.scene.sky = constant_sky(vec3(1));
    s.scene.sky->map = map;
    return s;
}

CaseResult spiked_sky(const CaseContext& context, int width, int x, int y, int size,
                      float radiance) {
    Judge judge(context, 3);
    for (const Technique technique : every_technique) {
        const Setup s = spiked(technique, width, x, y, size, radiance);
        const double background = 0.1f;
        const double expected = albedo / pi_d *
                                (pi_d * background + irradiance_about(make_sky(*s.scene.sky), x, y,
                                                                      size + 1, background));
        judge.known(label(s.settings), mean_over_seeds(s, context, effort_of(technique)), expected,
                    1e-3);
    }
    return judge.result();
}

CaseResult bright_pixel(const CaseContext& context) {
    return spiked_sky(context, 64, 20, 8, 1, 1e5f);
}

// Three texels of 2048 are half a degree, as the sun has.
CaseResult sun_disc(const CaseContext& context) {
    return spiked_sky(context, 2048, 700, 300, 3, 1e4f);
}

CaseResult nothing_to_see(const CaseContext& context) {
    Judge judge(context, 0);
    for (const Technique technique : every_technique) {
        const RenderSettings how = settings(technique, 8, 4);
        const auto mean = [&](const SceneDescription& d) {
            const Setup s{"nothing", d, floor_camera(), how};
            return image_mean(render(s, build(s), context, 16).image);
        };
        SceneDescription d;
        judge.holds("no geometry, no light: black", mean(d) == 0);
        d.lights = {point_light({0, 1, 0}, 1), sun({0, -1, 0}, 1)};
        judge.holds("no geometry: lamps are not seen", mean(d) == 0);
        d.sky = constant_sky(vec3(0.25f));
        judge.holds("no geometry: the sky is seen", mean(d) == 0.25);
        SceneDescription black;
        add(black, make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), lambert(vec3(0.5f)));
        judge.holds("no light: black", mean(black) == 0);
        black.lights = {spot_light({0, 1, 0}, {0, 2, 0}, 1, 0.3f, 0.6f)};
        judge.holds("a spot lamp that points away", mean(black) == 0);
        add(black, make_quad({-0.2f, 0.9f, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}), lamp(vec3(3)));
        judge.holds("a lamp that looks away", mean(black) == 0);
        SceneDescription absorbs;
        add(absorbs, make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), lambert(vec3(0)));
        absorbs.lights = d.lights;
        judge.holds("walls that absorb all", mean(absorbs) == 0);
    }
    return judge.result();
}

// The box with a point lamp near its ceiling: next event there has 1 / d^2 without bound, which no
// weight of bdpt's may let through.
CaseResult point_lamp_in_a_box(const CaseContext& context) {
    const auto setup = [](Technique technique) {
        Setup s{"box with a point lamp",
                {},
                camera_at({0, 0.5f, 1.9f}, {0, 0.5f, 0}, 0.7),
                settings(technique, 24, 8)};
        const Material white = lambert(vec3(0.73f));
        const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
        add(s.scene, make_quad({-0.5f, 0, 0.5f}, x, -z), white);
        add(s.scene, make_quad({-0.5f, 1, -0.5f}, x, z), white);
        add(s.scene, make_quad({-0.5f, 0, -0.5f}, x, y), white);
        add(s.scene, make_quad({-0.5f, 0, 0.5f}, -z, y), lambert({0.63f, 0.07f, 0.05f}));
        add(s.scene, make_quad({0.5f, 0, -0.5f}, z, y), lambert({0.14f, 0.45f, 0.09f}));
        s.scene.lights.push_back(point_light({0, 0.9f, 0}, 1));
        return s;
    };
    Judge judge(context, 1);
    const Setup box = setup(Technique::bdpt), other = setup(Technique::path);
    const RunningMean expected = mean_over_seeds(other, context, {64, 16});
    judge.equal("mean against path", mean_over_seeds(box, context, {32, 16}), expected);
    float brightest = 0;
    for (const double exponent : {1.0, 2.0, 8.0}) {
        Setup s = box;
        s.settings.exponents = {exponent};
        for (const vec3& p : render(s, build(s), context, 64).image.pixels)
            brightest = std::max(brightest, max_component(p));
    }
    // Right above the lamp: I / (pi d^2) times the albedo, and as much again from all around.
    const double known = 0.73 / (pi_d * 0.01) * 1.2;
    judge.holds(fmt::format("brightest pixel {:.3g} of at most {:.3g}", brightest, known),
                brightest < known);
    return judge.result();
}

}  // namespace

std::vector<ExtremeCase> light_cases() {
    return {
        {"lights", "hundred_thousand",
         "a floor under 100,000 point lamps has the sum of their light", false, hundred_thousand},
        {"lights", "only_delta", "a point, a spot and a directional lamp, and nothing to hit",
         false, only_delta},
        {"lights", "bright_pixel",
         "a floor under a sky with one texel a million times brighter than the rest", false,
         bright_pixel},
        {"lights", "sun_disc", "a floor under a sky with a sun of half a degree", false, sun_disc},
        {"lights", "nothing_to_see",
         "no geometry, no light, lamps that point away, walls that absorb: black, or the sky", true,
         nothing_to_see},
        {"lights", "point_lamp_in_a_box",
         "a box with a point lamp below its ceiling: no pixel runs away", false,
         point_lamp_in_a_box}};
}

}  // namespace midway::extreme
