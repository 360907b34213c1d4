// Intensity: every light a power of two brighter or dimmer, and lamps of 1e-9 and 1e9 side by side.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "report/extreme_groups.h"
#include "report/extreme_measure.h"
#include "report/extreme_scenes.h"
#include "scene/sky.h"

namespace midway::extreme {
namespace {

// Where `b` is not 2^k times `a`; below the normal floats there are no bits to keep.
std::string where_differs(const Image& a, const Image& b, int k) {
    constexpr float tiny = 2 * std::numeric_limits<float>::min();
    for (size_t i = 0; i < a.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const float expected = std::ldexp(a.pixels[i][c], k), found = b.pixels[i][c];
            if (expected == found || (expected < tiny && found < tiny)) continue;
            return fmt::format("2^{}: pixel {},{}: {:.9g} for {:.9g}", k, i % a.width, i / a.width,
                               found, expected);
        }
    return {};
}

CaseResult powers_of_two(const CaseContext& context) {
    const Setup plain = all_kinds({0, 0.1, 1, 2, 8, 32});
    const std::vector<Image> expected = render(plain, build(plain), context, 1).images;
    int checked = 0, same = 0;
    CaseResult r;
    for (int k = -60; k <= 60; ++k) {
        Setup s = plain;
        s.scene.lamp_strength = std::ldexp(1.0f, k);
        s.scene.sky->strength = std::ldexp(s.scene.sky->strength, k);
        const std::vector<Image> images = render(s, build(s), context, 1).images;
        for (size_t i = 0; i < images.size(); ++i) {
            const std::string difference = where_differs(expected[i], images[i], k);
            ++checked;
            same += difference.empty();
            if (!difference.empty() && r.detail.empty())
                r.detail = fmt::format("exponent {}, {}", s.settings.exponents[i], difference);
        }
    }
    r.passed = same == checked && image_mean(expected[0]) > 0.01;
    r.measured = fmt::format("{} of {} images bit-identical", same, checked);
    r.bar = "all";
    return r;
}

// Two rooms with a wall between: what the strong lamp does in the other one must not be felt.
CaseResult strong_beside_weak(const CaseContext& context) {
    const auto setup = [](float other, Technique technique) {
        Setup s{"lamps of 1e-9 and 1e9",
                {},
                camera_at({-1, 0.5f, 0.9f}, {-1, 0.2f, 0}, 0.8),
                settings(technique, 8, 5)};
        const auto room = [&](float x, float radiance) {
            add(s.scene, make_icosphere({x, 0.5f, 0}, 0.98f, 2, true), lambert(vec3(0.5f)));
            add(s.scene, make_quad({x - 0.2f, 0.9f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}),
                lamp(vec3(radiance)));
        };
        room(-1, 1e-9f);
        if (other > 0) room(1, other);
        return s;
    };
    Judge judge(context, 2);
    const auto alone = setup(0, Technique::path);
    const RunningMean expected = mean_over_seeds(alone, context, {128, 24});
    for (const Technique technique : {Technique::path, Technique::bdpt}) {
        Setup s = setup(1e9f, technique);
        s.settings.seed = 5;
        // One pick in ten finds the weak lamp.
        judge.equal(label(s.settings), mean_over_seeds(s, context, {512, 24}), expected);
    }
    return judge.result();
}

}  // namespace

std::vector<ExtremeCase> intensity_cases() {
    return {{"intensity", "powers_of_two",
             "all lights times 2^k, k = -60 to 60: the image is that factor brighter, bit for bit, "
             "for exponents 0 to 32",
             true, powers_of_two},
            {"intensity", "strong_beside_weak",
             "a room under a lamp of 1e-9 looks the same with one of 1e9 in the next room", false,
             strong_beside_weak}};
}

}  // namespace midway::extreme
