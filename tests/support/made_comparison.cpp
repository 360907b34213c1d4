#include "support/made_comparison.h"

#include <cmath>
#include <random>

namespace midway::test {
namespace {

constexpr int size = 256, seeds = 4, points = 30;
constexpr double time = 60;

struct Made {
    const char* label;
    const char* name;
    double exponent;
    double error;   // relMSE of one second
    double spread;  // between seeds, of the logarithm
    double samples_per_second;
};
constexpr Made techniques[] = {
    {"path", "path", 0, 0.3, 0.10, 12},    {"light", "light", 0, 0.5, 0.12, 14},
    {"bdpt:0", "bdpt", 0, 1.4, 0.30, 8.1}, {"bdpt:1", "bdpt", 1, 0.068, 0.05, 8},
    {"bdpt:2", "bdpt", 2, 0.060, 0.04, 8}, {"auto", "auto", 2, 0.052, 0.05, 9}};

// A room: grey walls, a red and a green one, a lamp, a ball with a bright spot below it.
vec3 room_at(double x, double y) {
    if (y < 0.08 && std::abs(x - 0.5) < 0.12) return vec3(12, 10, 7);
    const double ball = std::hypot(x - 0.62, y - 0.7);
    if (ball < 0.16) return vec3(float(0.9 - 4 * ball)) * vec3(0.5, 0.7, 0.9);
    const float falloff = float(0.6 / (0.25 + 2 * ((x - 0.5) * (x - 0.5) + y * y)));
    if (std::hypot((x - 0.4) / 3, y - 0.93) < 0.03) return vec3(4, 3.6f, 3);
    if (x < 0.15) return falloff * vec3(0.6f, 0.06f, 0.05f);
    if (x > 0.85) return falloff * vec3(0.1f, 0.45f, 0.09f);
    return falloff * vec3(0.7f, 0.68f, 0.62f);
}

Image room() {
    Image image(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) image.at(x, y) = room_at((x + .5) / size, (y + .5) / size);
    return image;
}

Image noisy(const Image& clean, const Made& made, std::mt19937& random) {
    Image image = clean;
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const double deviation = std::sqrt(made.error / time);
    const bool dots = made.exponent == 0 && made.name[0] == 'b';
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            vec3& p = image.at(x, y);
            p *= float(std::exp(deviation * normal(random) - deviation * deviation / 2));
            if (dots && uniform(random) < 0.002) p += vec3(float(8 / uniform(random)));
            if (made.name[0] == 'l' && std::hypot(x / 256. - 0.62, y / 256. - 0.7) < 0.16)
                p = vec3(0);
        }
    return image;
}

Interval times(const Interval& i, double factor) {
    return {i.value * factor, i.lower * factor, i.upper * factor};
}

void add_curves(TechniqueResult& t, const Made& made, std::mt19937& random) {
    std::normal_distribution<double> normal;
    t.curves.resize(seeds);
    for (int k = 0; k < points; ++k) {
        const double seconds = time * std::exp2((k - points + 1) / 4.0);
        double sum = 0;
        for (int s = 0; s < seeds; ++s) {
            t.curves[s].seed = 5 + s;
            t.curves[s].complete = true;
            ErrorPoint e{seconds * (1 + 0.01 * s), 2 * seconds,
                         std::uint64_t(std::max(1.0, made.samples_per_second * seconds))};
            e.relmse = made.error / seconds * std::exp(made.spread * normal(random));
            e.relmse_trimmed = e.relmse * (made.error > 1 ? 0.2 : 0.9);
            e.mse = e.relmse * 0.3;
            e.rmse = std::sqrt(e.mse);
            e.smape = 0.4 * std::sqrt(e.relmse);
            e.bias = 0.001 * normal(random);
            e.bias_z = normal(random);
            sum += e.relmse;
            t.curves[s].points.push_back(e);
        }
        const double mean = sum / seeds, half = 1.6 * made.spread * mean;
        BandPoint b{seconds, 2 * seconds, std::max(1.0, made.samples_per_second * seconds)};
        b.relmse = {mean, mean - half, mean + half};
        b.relmse_trimmed = times(b.relmse, made.error > 1 ? 0.2 : 0.9);
        b.mse = times(b.relmse, 0.3);
        b.smape = {0.4 * std::sqrt(mean), 0.38 * std::sqrt(mean), 0.42 * std::sqrt(mean)};
        t.band.push_back(b);
    }
}

TechniqueResult made_technique(const Made& made, const Image& clean) {
    std::mt19937 random(1 + unsigned(&made - techniques));
    TechniqueResult t;
    t.name = made.name;
    t.exponent = made.exponent;
    t.label = made.label;
    add_curves(t, made, random);
    t.fit = {{-1.01, -1.05, -0.97}, {-1.0, -1.04, -0.96}, points};
    for (const double level : {0.1, 0.01, 0.001}) {
        const double seconds = made.error / level;
        TimeTo to{level};
        if (seconds <= time) to.seconds = seconds;
        t.time_to.push_back(to);
    }
    if (t.label != "path") {
        const double ratio = techniques[0].error / made.error, wide = 3 * made.spread;
        t.efficiency = Interval{ratio, ratio * (1 - wide), ratio * (1 + wide)};
        t.efficiency_trimmed = t.efficiency;
    }
    t.final_mean = t.curves[0].points.back();
    t.final_mean.flip = 0.05;
    t.bias = {{0.0002, -0.0011, 0.0015}, 0.4, 4.2, false, false, "no bias seen"};
    t.image = noisy(clean, made, random);
    t.image_seed = 5;
    t.image_spp = std::uint64_t(made.samples_per_second * time);
    t.image_seconds = time;
    if (t.label == "light") {
        t.not_covered = {"what is seen in a smooth surface",
                         "light that reaches the camera only "
                         "through smooth glass"};
        t.bias = {{-0.031, -0.033, -0.029},
                  -48,
                  4.2,
                  false,
                  true,
                  "too dark, as expected: it does not cover all of this scene"};
    }
    return t;
}

}  // namespace

Comparison made_comparison(const std::string& name) {
    Comparison c;
    c.name = name;
    c.scene = "assets/" + name + ".glb";
    c.command = "midway compare assets/" + name + ".glb -o out --time 60 --seeds 4";
    c.settings = {{"size", "256x256"},           {"max bounces", "16"}, {"sampler", "sobol"},
                  {"filter", "blackman-harris"}, {"camera", "0"},       {"seed", "5"}};
    c.machine = {"A processor of some kind @ 2.50GHz", 2, "0.1.0", "native", "g++ 12.2.0"};
    c.reference = {"rendered",
                   "bdpt:2",
                   12000,
                   1500,
                   "bdpt:2 had the least error times seconds in a pilot of 2 s each.",
                   4e-7 * 3,
                   4e-5,
                   3e-5,
                   room()};
    for (const Made& made : techniques)
        c.techniques.push_back(made_technique(made, c.reference.image));
    c.left_out = {"KHR_materials_sheen: not supported"};
    c.warnings = {"bdpt:1, bdpt:2 and auto come within ten times of the reference's own error."};
    c.formula =
        "relMSE = mean over pixels and channels of (x - r)^2 / (r^2 + 0.01 m^2), m = mean "
        "luminance of the reference";
    c.method = "The techniques took turns in slices of a tenth of a second.";
    c.time = time;
    c.metric_seconds = 31;
    c.seeds = seeds;
    c.complete = true;
    return c;
}

SuiteReport made_suite() {
    SuiteReport suite;
    suite.name = "assets";
    suite.command = "midway compare --suite assets/suite.json -o out --time 10";
    suite.scenes_planned = 4;
    suite.seconds = 2400;
    const std::pair<const char*, double> scenes[] = {
        {"idol", 1}, {"terrace", 0.1}, {"plates", 0.2}};
    for (const auto& [name, factor] : scenes) {
        Comparison c = made_comparison(name);
        for (TechniqueResult& t : c.techniques)
            if (t.efficiency) t.efficiency = times(*t.efficiency, factor);
        suite.scenes.push_back(std::move(c));
    }
    suite.machine = suite.scenes[0].machine;
    return suite;
}

}  // namespace midway::test
