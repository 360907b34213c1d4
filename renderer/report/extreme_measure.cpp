#include "report/extreme_measure.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "math/student.h"
#include "report/extreme_scenes.h"
#include "scene/sky.h"

namespace midway::extreme {

RenderSettings settings(Technique technique, int size, int max_bounces) {
    RenderSettings s;
    s.technique = technique;
    s.width = s.height = size;
    s.max_bounces = max_bounces;
    s.filter = FilterKind::box;
    return s;
}

std::string label(const RenderSettings& s) {
    const std::string name(to_string(s.technique));
    return s.technique == Technique::bdpt ? fmt::format("{}:{}", name, s.exponents.front()) : name;
}

Setup all_kinds(const std::vector<double>& exponents) {
    Setup s{
        "all kinds", {}, camera_at({0, 1, 4}, {0, 0.5f, 0}, 0.8), settings(Technique::bdpt, 16, 6)};
    s.settings.exponents = exponents;
    s.camera.aperture_radius = 0.05;
    SceneDescription& d = s.scene;
    add(d, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(vec3(0.6f)));
    add(d, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4), vec3(0.2f)));
    add(d, make_icosphere({0.7f, 0.5f, 0}, 0.5f, 2, false, true), glass(0));
    add(d, make_icosphere({-0.7f, 0.4f, 0}, 0.4f, 2, false, true), metal(0.3f));
    add(d, make_icosphere({0, 0.3f, 0.8f}, 0.3f, 2, false, true),
        plastic(0.2f, {0.8f, 0.4f, 0.2f}));
    add(d, make_icosphere({0, 0.4f, -0.9f}, 0.4f, 2, false, true), glass(0.4f));
    d.lights = {point_light({1, 1.5f, 1}, 1), spot_light({-1, 2, 1}, {0, 0, 0}, 3, 0.2f, 0.5f),
                sun({0.3f, -1, -0.2f}, 0.5f)};
    d.sky = default_sky();
    return s;
}

std::shared_ptr<const Scene> build(const Setup& setup) {
    std::vector<std::string> warnings;
    return std::make_shared<const Scene>(build_scene(setup.scene, warnings));
}

Rendered render(const Setup& setup, const std::shared_ptr<const Scene>& scene,
                const CaseContext& context, std::uint64_t passes) {
    ProgressiveRenderer renderer(scene, setup.camera, setup.settings, {.threads = context.threads});
    renderer.render_passes(passes);
    Rendered r;
    r.statistics = renderer.statistics();
    const NonFinite& bad = r.statistics.nonfinite;
    if (bad.count > 0)
        throw std::runtime_error(
            fmt::format("{} samples are not finite ({}, {}, --debug-pixel "
                        "{},{},{}, seed {})",
                        bad.count, setup.name, label(setup.settings), bad.x, bad.y, bad.pass,
                        setup.settings.seed));
    if (r.statistics.fixed.overflow > 0)
        throw std::runtime_error(fmt::format("{} contributions do not fit into the film ({}, {})",
                                             r.statistics.fixed.overflow, setup.name,
                                             label(setup.settings)));
    for (size_t i = 0; i < setup.settings.exponents.size(); ++i)
        r.images.push_back(renderer.image(static_cast<int>(i)));
    r.image = r.images.front();
    r.film.assign(renderer.film().words().begin(), renderer.film().words().end());
    r.unit_exponent = renderer.film().unit_exponent();
    return r;
}

double image_mean(const Image& image) {
    double sum = 0;
    for (const vec3& p : image.pixels) sum += (double(p.x) + p.y + p.z) / 3;
    return sum / double(image.pixels.size());
}

namespace {

std::uint64_t passes_of(const Effort& e, const CaseContext& context) {
    return std::max<std::uint64_t>(1, std::llround(double(e.passes) * context.effort));
}

std::uint64_t seed_of(const Setup& s, const CaseContext& context, int i) {
    return hash_combine(s.settings.seed + 1000003 * context.seed, std::uint64_t(i));
}

}  // namespace

RunningMean mean_over_seeds(const Setup& setup, const CaseContext& context, const Effort& effort) {
    const auto scene = build(setup);
    Setup one = setup;
    RunningMean m;
    for (int i = 0; i < effort.seeds; ++i) {
        one.settings.seed = seed_of(setup, context, i);
        m.add(image_mean(render(one, scene, context, passes_of(effort, context)).image));
    }
    return m;
}

RunningMean difference_over_seeds(const Setup& a, const Setup& b, const CaseContext& context,
                                  const Effort& effort) {
    const auto scene_a = build(a), scene_b = build(b);
    Setup one = a, other = b;
    RunningMean m;
    for (int i = 0; i < effort.seeds; ++i) {
        one.settings.seed = other.settings.seed = seed_of(a, context, i);
        const std::uint64_t passes = passes_of(effort, context);
        m.add(image_mean(render(one, scene_a, context, passes).image) -
              image_mean(render(other, scene_b, context, passes).image));
    }
    return m;
}

Judge::Judge(const CaseContext& context, int comparisons, double sharpness)
    : level_(comparisons > 0 ? sidak_level(case_alarm, comparisons) : 0),
      sharpness_(sharpness / std::sqrt(std::min(1.0, context.effort))),
      comparisons_(comparisons) {}

void Judge::compare(const std::string& what, double relative, double reach, double model_error) {
    ++done_;
    // Images are rounded to float.
    model_error += 1e-6;
    const double share = std::abs(relative) / (reach + model_error);
    const std::string text = fmt::format("{:+.3g} % within {:.2g} % ({})", 100 * relative,
                                         100 * (reach + model_error), what);
    if (!(share <= 1)) failures_ += "\n" + text;
    if (!(reach <= sharpness_)) failures_ += "\ntoo noisy to tell: " + text;
    if (share > worst_) {
        worst_ = share;
        worst_text_ = text;
    }
}

void Judge::equal(const std::string& what, const RunningMean& a, const RunningMean& b,
                  double model_error) {
    const double va = a.variance() / double(a.count), vb = b.variance() / double(b.count);
    const double scale = std::abs(b.mean);
    if (!(scale > 0)) return holds(what + " is not black", false);
    // Degrees of freedom of two unequal variances (Welch 1947).
    const double n = va + vb > 0
                         ? (va + vb) * (va + vb) /
                               (va * va / double(a.count - 1) + vb * vb / double(b.count - 1))
                         : 1.0;
    compare(what, (a.mean - b.mean) / scale, student_limit(level_, n) * std::sqrt(va + vb) / scale,
            model_error);
}

void Judge::known(const std::string& what, const RunningMean& a, double expected,
                  double model_error) {
    RunningMean difference = a;
    difference.mean -= expected;
    zero(what, difference, expected, model_error);
}

void Judge::zero(const std::string& what, const RunningMean& difference, double scale,
                 double model_error) {
    const double error = difference.estimate().standard_error;
    compare(what, difference.mean / scale,
            student_limit(level_, double(difference.count - 1)) * error / scale, model_error);
}

void Judge::holds(const std::string& what, bool yes) {
    ++facts_;
    if (!yes) failures_ += "\n" + what;
}

CaseResult Judge::result() const {
    CaseResult r;
    r.passed = failures_.empty() && done_ == comparisons_;
    r.measured = done_ > 0 ? "worst of " + std::to_string(done_) + ": " + worst_text_
                           : std::to_string(facts_) + " facts";
    r.bar = done_ > 0 ? fmt::format("all within, at {:.0e}", case_alarm) : "all hold";
    if (!failures_.empty()) r.detail = failures_.substr(1);
    if (done_ != comparisons_)
        r.detail += fmt::format("\n{} comparisons of {}", done_, comparisons_);
    r.false_alarm = done_ > 0 ? case_alarm : 0;
    return r;
}

double mean_over_floor(const Setup& setup, const std::function<double(const dvec3&)>& radiance) {
    constexpr int n = 400;
    const Camera c = make_camera(setup.camera, {}, n, n);
    const dvec3 eye(setup.camera.to_world[3]);
    double sum = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const dvec3 w(camera_direction(c, c.position, {x + 0.5f, y + 0.5f}));
            sum += radiance(eye - w * (eye.y / w.y));
        }
    return sum / (n * n);
}

}  // namespace midway::extreme
