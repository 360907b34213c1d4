#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "image/file.h"
#include "outputs.h"
#include "plan_json.h"
#include "render/coverage.h"
#include "render/json_text.h"
#include "render/leave_outs.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

Json strategies_json(const RenderStatistics& s) {
    Json a = Json::array();
    for (const StrategyStatistics& k : s.strategies)
        a.push_back({{"s", k.strategy.s},
                     {"t", k.strategy.t},
                     {"samples", k.samples},
                     {"energy", k.energy},
                     {"second_moment", k.second_moment},
                     {"rays", k.rays}});
    return a;
}

// What was asked for and what it cost.
Json run_json(const PreparedScene& p, const RenderSettings& settings, const ProgressiveRenderer& r,
              const RunFigures& figures) {
    const RenderStatistics s = r.statistics();
    struct rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    Json j;
    j["scene"] = p.description.source;
    j["technique"] = to_string(settings.technique);
    if (settings.exponents.size() == 1)
        j["exponent"] = settings.exponents.front();
    else
        j["exponent"] = settings.exponents;
    j["families"] = to_string(r.estimator().families);
    j["size"] = {settings.width, settings.height};
    j["max_bounces"] = settings.max_bounces;
    j["seed"] = settings.seed;
    j["threads"] = r.threads();
    j["spp"] = r.passes();
    j["interrupted"] = figures.interrupted;
    j["seconds_load"] = p.seconds_load;
    j["seconds_build"] = p.seconds_build;
    j["seconds_render"] = figures.seconds_render;
    j["cpu_seconds"] = figures.cpu_seconds;
    j["paths_camera"] = s.rays.camera_paths;
    j["paths_light"] = s.rays.light_paths;
    j["rays_closest"] = s.rays.closest;
    j["rays_shadow"] = s.rays.shadow;
    j["peak_memory_bytes"] = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return j;
}

// What the scene does not need, and what the technique cannot show of it.
void add_gaps(Json& j, const PreparedScene& p, Technique technique, const ProgressiveRenderer& r) {
    const Estimator& e = r.estimator();
    const SceneFeatures features = scene_features(*p.scene);
    j["left_out"] = Json::array();
    for (const LeaveOut& line : leave_outs(*p.scene))
        j["left_out"].push_back({{"what", line.what}, {"why", line.why}});
    if (r.layers().empty())
        j["left_out"].push_back(
            {{"what", "strategy images"}, {"why", "nobody asked for them (--strategies)"}});
    j["not_covered"] = Json::array();
    for (const std::string& what : not_covered(features, e.families, e.direct_lamps))
        j["not_covered"].push_back({{"technique", to_string(technique)}, {"what", what}});
}

}  // namespace

void write_stats(const std::string& path, const PreparedScene& p, const RenderSettings& settings,
                 const ProgressiveRenderer& r, const RunFigures& figures) {
    const RenderStatistics s = r.statistics();
    Json j = run_json(p, settings, r, figures);
    j["nonfinite"] = s.nonfinite.count;
    j["nonfinite_first"] = nullptr;
    if (s.nonfinite.count > 0)
        j["nonfinite_first"] = {
            {"x", s.nonfinite.x}, {"y", s.nonfinite.y}, {"sample", s.nonfinite.pass}};
    j["film_inexact"] = s.fixed.inexact;
    j["film_overflow"] = s.fixed.overflow;
    j["clamped"] = s.clamped;
    j["strategies"] = strategies_json(s);
    add_gaps(j, p, settings.technique, r);
    if (figures.decision) {
        j["plan"] = plan_json(*figures.decision);
        const Families before = families_of(settings.technique), now = r.estimator().families;
        for (const Family f : {Family::light_tracing, Family::connection})
            if (before.has(f) && !now.has(f) && figures.decision->forecasts.size() > 1)
                j["left_out"].push_back({{"what", f == Family::connection ? "connect" : "light"},
                                         {"why", "auto: " + describe(*figures.decision)}});
    }
    atomic_write(path, json_text(j) + "\n");
}

}  // namespace midway
