// Exponent: the weights of 0, 0.1, 1, 2, 8 and 32 sum to one on stiff paths, by the audit's
// direct product form in long double.
#include <fmt/format.h>

#include <cmath>

#include "report/audit.h"
#include "report/extreme_groups.h"
#include "report/extreme_measure.h"
#include "report/extreme_scenes.h"

namespace midway::extreme {
namespace {

using Make = std::function<Setup()>;

void add_floor(SceneDescription& d) {
    add(d, make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), lambert(vec3(0.6f)));
    add(d, make_quad({-1, 0, -1}, {2, 0, 0}, {0, 1.5f, 0}), lambert({0.3f, 0.5f, 0.7f}));
}

Setup view(const std::string& name, int max_bounces) {
    return {name,
            {},
            camera_at({0, 0.8f, 3}, {0, 0.4f, 0}, 0.6),
            settings(Technique::bdpt, 16, max_bounces)};
}

Setup tiny_lamp() {
    Setup s = view("lamp of 1e-7", 5);
    add_floor(s.scene);
    add(s.scene, make_disc({0, 0.75f, 0}, {0, -1, 0}, 1e-7f), lamp(vec3(1e12f)));
    return s;
}

Setup huge_lamp() {
    Setup s = view("lamp 10 times the scene", 5);
    add_floor(s.scene);
    add(s.scene, make_disc({0, 3, 0}, {0, -1, 0}, 20), lamp(vec3(1)));
    return s;
}

Setup ball_under_lamp(const Material& m) {
    Setup s = view(fmt::format("ball of roughness {:g}, index {:g}", m.roughness, m.ior), 8);
    add_floor(s.scene);
    add(s.scene, make_icosphere({0, 0.5f, 0}, 0.4f, 2, false, true), m);
    add(s.scene, make_quad({-0.3f, 1.4f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}),
        lamp(vec3(3), vec3(0.3f)));
    return s;
}

Setup corner_at(float away) {
    Setup s{fmt::format("corner at {:g}", away),
            {},
            camera_at({0.4f, 0.4f, 0.4f}, vec3(0), 4 * away),
            settings(Technique::bdpt, 16, 6)};
    const Material m = lamp(vec3(1), vec3(0.5f));
    add(s.scene, make_quad(vec3(0), {0, 0, 1}, {1, 0, 0}), m);
    add(s.scene, make_quad(vec3(0), {0, 1, 0}, {0, 0, 1}), m);
    add(s.scene, make_quad(vec3(0), {1, 0, 0}, {0, 1, 0}), m);
    return s;
}

Setup far_apart() {
    Setup s = view("lamps of 1e-9 and 1e9", 6);
    add_floor(s.scene);
    add(s.scene, make_quad({-0.8f, 1.2f, -0.3f}, {0.4f, 0, 0}, {0, 0, 0.4f}), lamp(vec3(1e-9f)));
    add(s.scene, make_quad({0.4f, 1.2f, -0.3f}, {0.4f, 0, 0}, {0, 0, 0.4f}), lamp(vec3(1e9f)));
    return s;
}

Setup small_in_large() {
    Setup s{"1e-3 in 1e3",
            {},
            camera_at({0, 0, 0.004f}, vec3(0), 0.8),
            settings(Technique::bdpt, 16, 6)};
    add(s.scene, make_icosphere(vec3(0), 1e3f, 2, true), lamp(vec3(1), vec3(0.5f)));
    add(s.scene, make_icosphere(vec3(0), 1e-3f, 2, false, true), plastic(0.3f));
    return s;
}

Setup deep_room() {
    Setup s{"60 bounces",
            {},
            camera_at({0.2f, 0.1f, 0}, {1, 0.3f, 0.5f}, 1.0),
            settings(Technique::bdpt, 4, 20)};
    add(s.scene, make_icosphere(vec3(0), 1, 2, true), lamp(vec3(1), vec3(0.999f)));
    return s;
}

Setup bright_sky() {
    Setup s = view("sky with a texel of 1e6", 6);
    add_floor(s.scene);
    add(s.scene, make_icosphere({0, 0.5f, 0}, 0.4f, 2, false, true), metal(0.1f));
    auto map = std::make_shared<Image>(64, 32);
    map->pixels.assign(map->pixels.size(), vec3(0.1f));
    map->at(20, 8) = vec3(1e5f);
    s.scene.sky = constant_sky(vec3(1));
    s.scene.sky->map = map;
    s.scene.lights = {sun({0.3f, -1, -0.2f}, 0.5f), point_light({0, 1, 0.5f}, 0.3f)};
    return s;
}

std::vector<std::pair<std::string, Make>> stiff_scenes() {
    std::vector<std::pair<std::string, Make>> all = {{"all_kinds", [] { return all_kinds({2}); }},
                                                     {"tiny_lamp", tiny_lamp},
                                                     {"huge_lamp", huge_lamp},
                                                     {"corner", [] { return corner_at(1e-5f); }},
                                                     {"strong_beside_weak", far_apart},
                                                     {"small_in_large", small_in_large},
                                                     {"deep_room", deep_room},
                                                     {"bright_sky", bright_sky}};
    for (const float roughness : {1e-6f, 0.0318f, 0.1f}) {
        all.push_back({fmt::format("metal_{:g}", roughness),
                       [=] { return ball_under_lamp(metal(roughness)); }});
        all.push_back({fmt::format("glass_{:g}", roughness),
                       [=] { return ball_under_lamp(glass(roughness, 1.5f)); }});
    }
    for (const float ior : {1 + 1e-6f, 1.002f, 3.0f})
        all.push_back(
            {fmt::format("index_{:.6g}", ior), [=] { return ball_under_lamp(glass(0.2f, ior)); }});
    return all;
}

// Given the same densities, recursive weights equal direct ones and sum to one, for every exponent.
CaseResult weights(const Make& make, std::int64_t paths, const CaseContext& context) {
    const Setup s = make();
    RenderSettings how = s.settings;
    how.seed = 1 + 1000003 * context.seed;
    AuditOptions options;
    options.paths = std::llround(double(paths) * context.effort);
    options.rays = 0;
    options.threads = context.threads;
    options.float_recursion = false;
    const AuditResult a = audit(*build(s), s.camera, how, options);
    double recursive = 0, sum = 0, exponent = 0;
    for (const WeightAudit& w : a.weights) {
        recursive = std::max(recursive, w.recursive.worst());
        if (!(w.same_sum.worst() <= sum)) {
            sum = w.same_sum.worst();
            exponent = w.exponent;
        }
    }
    CaseResult r;
    r.passed = recursive <= 1e-9 && sum <= 1e-9 && a.samples.nonfinite == 0 && a.paths > 0 &&
               a.samples.overflow == 0;
    r.measured =
        fmt::format("recursion {:.1e}, sum {:.1e} off in {} paths, pdfs over {:.0f} decades",
                    recursive, sum, a.paths, a.pdf_a.high - a.pdf_a.low);
    r.bar = "<= 1e-9, nothing non-finite";
    r.detail = fmt::format("worst sum at exponent {:g}; {} values not finite", exponent,
                           a.samples.nonfinite);
    return r;
}

}  // namespace

std::vector<ExtremeCase> exponent_cases() {
    std::vector<ExtremeCase> cases;
    for (const auto& [name, make] : stiff_scenes()) {
        const auto run = [make](const CaseContext& c) { return weights(make, 250000, c); };
        cases.push_back({"exponent", name,
                         "weights of exponents 0 to 32 are those of the direct form and sum to one",
                         true, run});
    }
    return cases;
}

}  // namespace midway::extreme
