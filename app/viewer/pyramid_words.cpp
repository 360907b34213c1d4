#include "viewer/pyramid_words.h"

#include <fmt/format.h>

#include <exception>

#include "render/coverage.h"

namespace midway {
namespace {

std::string counted(int n, const char* one, const char* many) {
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

}  // namespace

CellShares shares_of(const StrategySnapshot& s, const Strategy& k) {
    double energy = 0, variance = 0, rays = 0;
    for (const CellSnapshot& c : s.cells) {
        energy += c.found.energy;
        variance += c.variance;
        rays += double(c.found.rays);
    }
    const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };
    const CellSnapshot* cell = s.find(k);
    if (!cell) return {};
    return {share(cell->found.energy, energy), share(cell->variance, variance),
            share(double(cell->found.rays), rays)};
}

std::string percent(double share) {
    const double p = 100 * share;
    if (!(p > 0)) return "-";
    if (p < 0.1) return "< 0.1 %";
    return fmt::format("{:.{}f} %", p, p < 9.95 ? 1 : 0);
}

std::string samples_in_words(std::uint64_t n) {
    return fmt::format("{} {} per pixel", n, n == 1 ? "sample" : "samples");
}

std::string what_it_does(const Strategy& k) {
    if (k == longer_paths)
        return "All strategies for paths of more than 7 bounces share this cell.";
    if (k == Strategy{1, 1}) return "The lens would be joined to a point on a lamp.";
    const std::string surfaces = counted(k.s - 1, "surface", "surfaces");
    switch (family_of(k)) {
        case Family::emitter_hit:
            if (k.s == 2) return "The camera's ray meets a lamp or the sky.";
            return fmt::format(
                "A walk from the camera over {} happens to meet a lamp or the sky. Good at large "
                "lamps and at what is seen in mirrors; small lamps are met seldom.",
                counted(k.s - 2, "surface", "surfaces"));
        case Family::next_event:
            return fmt::format(
                "A walk from the camera over {}; the last one is joined to a point chosen on a "
                "light. Good at small lamps on rough surfaces; finds no caustic.",
                surfaces);
        case Family::light_tracing:
            return fmt::format(
                "A walk from a light over {}; the last one is joined to the lens. Good at "
                "caustics; finds nothing that is seen in mirrors or clear glass.",
                counted(k.t - 1, "surface", "surfaces"));
        case Family::connection:
            return fmt::format(
                "A walk from the camera over {} and one from a light over {}, joined by an edge. "
                "Good where light is hard to reach from both ends; needs two rough surfaces.",
                surfaces, counted(k.t - 1, "surface", "surfaces"));
    }
    return "";
}

theme::Color family_color(Family family) {
    switch (family) {
        case Family::emitter_hit:
            return theme::rgb(0x2b8f82);
        case Family::next_event:
            return theme::rgb(0x5fd0c1);
        case Family::connection:
            return theme::rgb(0xa9b07a);
        case Family::light_tracing:
            return theme::light;
    }
    return theme::text_dim;
}

void update_left_out(App& app) {
    PyramidPanel& panel = app.ui.panel.pyramid;
    const Document& d = app.document;
    if (!d.prepared) return;
    const Scene& scene = *d.prepared->scene;
    const std::uint64_t job = app.snapshot ? app.snapshot->job : 0;
    const std::optional<Plan> plan = app.snapshot ? app.snapshot->plan : std::nullopt;
    if (panel.left_out_scene == &scene && panel.left_out_job == job && panel.left_out_plan == plan)
        return;
    panel.left_out_scene = &scene;
    panel.left_out_job = job;
    panel.left_out_plan = plan;
    panel.left_out.assign(strategy_count(cell_edges), {});
    try {
        RenderSettings settings = app.render.settings;
        settings.plan = plan;
        const Estimator e = make_estimator(scene, d.prepared->camera, settings);
        const SceneFeatures features = scene_features(scene);
        for (int edges = 1; edges <= cell_edges; ++edges)
            for (int s = 1; s <= edges + 1; ++s) {
                const Strategy k{s, edges + 1 - s};
                panel.left_out[strategy_index(k)] = why_left_out(k, features, e, settings);
            }
    } catch (const std::exception&) {
        panel.left_out.clear();  // the render says what is wrong with the settings
    }
}

std::string left_out_reason(const App& app, const Strategy& k) {
    const std::vector<std::string>& reasons = app.ui.panel.pyramid.left_out;
    if (k == longer_paths || strategy_index(k) >= reasons.size()) return "";
    return reasons[strategy_index(k)];
}

}  // namespace midway
