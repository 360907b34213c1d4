#include "report/reference_pilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "math/hash.h"
#include "render/waves.h"

namespace midway {
namespace {

struct Pilot {
    const TechniqueChoice* choice = nullptr;
    Image image, variance;
    double seconds = 0, error_time = 0;
};

// Both halves hold two passes at least.
Pilot render_pilot(const ReferencePlan& plan, const TechniqueChoice& choice,
                   const CompareHooks& hooks) {
    RenderSettings s = choice.settings;
    s.seed = hash_combine(plan.settings.seed, 0x70696c6f74);
    RendererOptions options;
    options.threads = plan.threads;
    ProgressiveRenderer r(plan.scene->scene, plan.scene->camera, s, options);
    WaveLimits first, rest;
    first.passes = 4;
    Pilot p;
    p.choice = &choice;
    p.seconds = render_in_waves(r, first, hooks.stop, [](const WaveState&) {});
    if (p.seconds < plan.pilot_seconds) {
        rest.seconds = plan.pilot_seconds - p.seconds;
        p.seconds += render_in_waves(r, rest, hooks.stop, [](const WaveState&) {});
    }
    p.image = r.image();
    p.variance = r.variance();
    return p;
}

Image median_of(const std::vector<Pilot>& pilots) {
    Image median = pilots.front().image;
    std::vector<float> values(pilots.size());
    // The lower one of two: a firefly is never below.
    const size_t middle = (pilots.size() - 1) / 2;
    for (size_t i = 0; i < median.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            for (size_t k = 0; k < pilots.size(); ++k) values[k] = pilots[k].image.pixels[i][c];
            std::nth_element(values.begin(), values.begin() + middle, values.end());
            median.pixels[i][c] = values[middle];
        }
    return median;
}

double relative_error(const Image& variance, const Image& reference) {
    const double epsilon = 0.01 * sqr(mean_luminance(reference));
    double sum = 0;
    for (size_t i = 0; i < reference.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double v = variance.pixels[i][c];
            if (v > 0) sum += v / (sqr(double(reference.pixels[i][c])) + epsilon);
        }
    return sum / (3 * double(reference.pixels.size()));
}

}  // namespace

std::vector<const TechniqueChoice*> best_covering(const ReferencePlan& plan) {
    size_t least = ~size_t{0};
    std::vector<const TechniqueChoice*> best;
    for (const TechniqueChoice& t : plan.candidates) {
        const size_t gaps = uncovered_kinds(*plan.scene, t.settings).size();
        if (gaps < least) best.clear();
        least = std::min(least, gaps);
        if (gaps == least) best.push_back(&t);
    }
    return best;
}

std::optional<PilotResult> run_pilot(const ReferencePlan& plan, const CompareHooks& hooks) {
    const std::vector<const TechniqueChoice*> choices = best_covering(plan);
    hooks.skip(plan.pilot_seconds * double(plan.candidates.size() - choices.size()));
    if (choices.size() == 1)
        return PilotResult{choices.front()->label,
                           "no other of the techniques covers as much of the scene"};
    std::vector<Pilot> pilots;
    for (const TechniqueChoice* t : choices) {
        pilots.push_back(render_pilot(plan, *t, hooks));
        hooks.progress("pilot, " + t->label, plan.pilot_seconds);
        if (hooks.stop()) return {};
    }
    const Image median = median_of(pilots);
    std::string figures;
    const Pilot* best = &pilots.front();
    for (Pilot& p : pilots) {
        p.error_time = relative_error(p.variance, median) * p.seconds;
        figures +=
            fmt::format("{}{} {:.3g}", figures.empty() ? "" : ", ", p.choice->label, p.error_time);
        if (p.error_time < best->error_time) best = &p;
    }
    return PilotResult{best->choice->label,
                       fmt::format("lowest relMSE x seconds in a pilot of {:.2g} s each: {}",
                                   plan.pilot_seconds, figures)};
}

}  // namespace midway
