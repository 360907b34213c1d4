#include "report/convergence.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "render/film_file.h"
#include "render/renderer.h"
#include "report/convergence_state.h"
#include "report/error_log.h"

namespace midway {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double longest_slice_seconds = 0.5;
constexpr double points_per_doubling = 4;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// One seed of one technique under way.
struct Runner {
    RenderSettings settings;
    std::string path, key;
    std::unique_ptr<ProgressiveRenderer> renderer;  // absent where the kept curve is complete
    CurveRun run;
    std::uint64_t nonfinite_before = 0;
    double cpu_before = 0;
    bool changed = false;
};

bool is_complete(const CurveRun& run, const ConvergencePlan& plan) {
    return run.passes.total() > 0 && run.seconds >= plan.seconds;
}

// Number of the last time T 2^(-k/4) that has passed.
double grid_place(double seconds, const ConvergencePlan& plan) {
    return std::floor(points_per_doubling * std::log2(seconds / plan.seconds) + 1e-9);
}

double next_grid_time(double seconds, const ConvergencePlan& plan) {
    if (!(seconds > 0)) return 0;
    return plan.seconds * std::exp2((grid_place(seconds, plan) + 1) / points_per_doubling);
}

RenderSettings with_seed(RenderSettings s, int number) {
    s.seed += static_cast<std::uint64_t>(number);
    return s;
}

// The film that a kept curve ends with; empty where it is of other samples or damaged.
std::optional<FilmFile> kept_film(const ConvergencePlan& plan, const Runner& r) {
    try {
        FilmFile file = read_film(r.path + ".film");
        const FilmHeader own = film_header(*plan.scene, r.settings, *r.renderer);
        const bool same = render_difference(own, file.header).empty();
        if (same && pass_counts(file.header).total() == r.run.passes.total()) return file;
    } catch (const std::runtime_error&) {
    }
    return {};
}

Runner open_runner(const ConvergencePlan& plan, const TechniqueChoice& t, int seed,
                   bool& restarted) {
    Runner r;
    r.settings = with_seed(t.settings, seed);
    r.path = curve_path(plan, t.label, r.settings.seed);
    r.key = curve_key(plan, r.settings);
    RendererOptions options;
    options.threads = plan.threads;
    r.renderer = std::make_unique<ProgressiveRenderer>(plan.scene->scene, plan.scene->camera,
                                                       r.settings, options);
    const KeptCurve kept = read_curve(r.path, r.key, r.run);
    std::optional<FilmFile> film;
    if (kept == KeptCurve::usable) film = kept_film(plan, r);
    restarted |= kept == KeptCurve::stale || (kept == KeptCurve::usable && !film);
    if (film && is_complete(r.run, plan)) {
        r.renderer.reset();
        return r;
    }
    if (film)
        r.renderer->adopt(std::move(film->films), r.run.passes.total());
    else
        r.run = {};
    r.run.curve.seed = r.settings.seed;
    if (r.run.passes.total() == 0) {
        r.run.seconds = t.seconds_before;
        r.run.cpu_seconds = t.cpu_seconds_before;
    }
    r.nonfinite_before = r.run.nonfinite;
    r.cpu_before = r.run.cpu_seconds;
    return r;
}

// The mean of each half of the image, which the tests of bias need when the curve ends.
void take_luminances(Runner& r) {
    const PassCounts n = r.run.passes;
    if (!r.renderer || n.total() == 0) return;
    r.run.luminance_a = half_luminance(r.renderer->film(), n, 0);
    r.run.luminance_b = n.b > 0 ? half_luminance(r.renderer->film(), n, 1) : unknown_number;
}

// Keeps what has been done since the last time. The points are written last: a film without its
// points is left aside.
void keep(Runner& r, const ConvergencePlan& plan) {
    if (!r.changed) return;
    take_luminances(r);
    write_film(r.path + ".film", film_header(*plan.scene, r.settings, *r.renderer), *r.renderer);
    write_curve(r.path, r.key, r.run);
    r.changed = false;
}

void measure(Runner& r, const ConvergencePlan& plan) {
    const auto start = Clock::now();
    const Film& film = r.renderer->film();
    const PassCounts n = r.renderer->counts();
    const bool last = is_complete(r.run, plan);
    r.run.curve.points.push_back(
        measure_error(*plan.reference, film, n, {r.run.seconds, r.run.cpu_seconds}, last));
    r.run.metric_seconds += seconds_since(start);
}

// Whole passes until the curve has rendered for so many seconds, one at least; then the error,
// where a time of the grid has passed.
void advance(Runner& r, const ConvergencePlan& plan, double until) {
    const double before = r.run.seconds;
    do {
        const double passes = double(r.renderer->passes());
        std::uint64_t wave = 1;
        if (passes > 0) {
            // Half of what is left, and in the end single passes: the curve ends with the first
            // pass after its time even where the machine slows down.
            const double fits = 0.5 * (until - r.run.seconds) / (r.run.seconds / passes);
            wave = static_cast<std::uint64_t>(std::clamp(fits, 1.0, passes));
        }
        const auto start = Clock::now();
        r.renderer->render_passes(wave);
        r.run.seconds += seconds_since(start);
        r.run.cpu_seconds = r.cpu_before + r.renderer->cpu_seconds();
    } while (r.run.seconds < until);
    r.run.passes = r.renderer->counts();
    r.run.nonfinite = r.nonfinite_before + r.renderer->statistics().nonfinite.count;
    r.run.curve.complete = is_complete(r.run, plan);
    r.changed = true;
    if (before == 0 || grid_place(r.run.seconds, plan) > grid_place(before, plan)) measure(r, plan);
}

// Takes turns until all curves are complete; false where it was stopped. Who is behind goes on, up
// to the next time of the grid or by one slice.
bool take_turns(const ConvergencePlan& plan, const CompareHooks& hooks,
                std::vector<Runner>& runners, const std::string& stage) {
    auto kept = Clock::now();
    while (true) {
        const auto behind = std::min_element(
            runners.begin(), runners.end(),
            [](const Runner& a, const Runner& b) { return a.run.seconds < b.run.seconds; });
        if (is_complete(behind->run, plan)) return true;
        if (hooks.stop()) return false;
        const double before = behind->run.seconds;
        advance(*behind, plan,
                std::min(next_grid_time(before, plan), before + longest_slice_seconds));
        hooks.progress(stage + ", " + plan.techniques[behind - runners.begin()].label,
                       std::min(behind->run.seconds, plan.seconds) - before);
        if (seconds_since(kept) > plan.keep_every_seconds) {
            for (Runner& r : runners) keep(r, plan);
            kept = Clock::now();
        }
    }
}

Image last_image(const Runner& r) {
    if (r.renderer) return r.renderer->passes() > 0 ? r.renderer->image() : Image();
    const FilmFile file = read_film(r.path + ".film");
    return resolve(file.films.front(), pass_counts(file.header));
}

// One seed of all techniques; false where it was stopped.
bool run_seed(const ConvergencePlan& plan, const CompareHooks& hooks, int seed,
              ConvergenceRun& result) {
    std::vector<Runner> runners;
    for (const TechniqueChoice& t : plan.techniques) {
        runners.push_back(open_runner(plan, t, seed, result.restarted));
        hooks.skip(std::min(runners.back().run.seconds, plan.seconds));
    }
    const bool done =
        take_turns(plan, hooks, runners,
                   "seed " + std::to_string(seed + 1) + " of " + std::to_string(plan.seeds));
    for (size_t i = 0; i < runners.size(); ++i) {
        Runner& r = runners[i];
        // What was done since the last time of the grid is worth a point too.
        if (r.renderer && r.run.passes.total() > 0 &&
            (r.run.curve.points.empty() || r.run.curve.points.back().spp != r.run.passes.total())) {
            measure(r, plan);
            r.changed = true;
        }
        keep(r, plan);
        r.run.curve.complete = is_complete(r.run, plan);
        if (seed == 0) result.techniques[i].image = last_image(r);
        if (r.run.passes.total() > 0) result.techniques[i].seeds.push_back(std::move(r.run));
    }
    return done;
}

}  // namespace

std::vector<std::string> uncovered_paths(const PreparedScene& p, const RenderSettings& settings) {
    const Estimator e = make_estimator(*p.scene, p.camera, settings);
    return not_covered(scene_features(*p.scene), e.families, e.direct_lamps);
}

std::vector<PathKind> uncovered_kinds(const PreparedScene& p, const RenderSettings& settings) {
    const Estimator e = make_estimator(*p.scene, p.camera, settings);
    return kinds_not_covered(scene_features(*p.scene), e.families, e.direct_lamps);
}

ConvergenceRun run_convergence(const ConvergencePlan& plan, const CompareHooks& hooks) {
    std::filesystem::create_directories(plan.folder);
    ConvergenceRun result;
    result.techniques.resize(plan.techniques.size());
    for (int seed = 0; seed < plan.seeds; ++seed)
        if (!run_seed(plan, hooks, seed, result)) return result;
    result.complete = true;
    return result;
}

std::string file_label(const std::string& label) {
    std::string text = label;
    for (char& c : text)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '-';
    return text;
}

}  // namespace midway
