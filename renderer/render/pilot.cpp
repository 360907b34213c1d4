#include "render/pilot.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>

#include "render/coverage.h"
#include "render/pilot_sums.h"

namespace midway {
namespace {

// As in the trimmed relMSE: a few pixels that no plan can help must not decide.
constexpr double trimmed_share = 0.001;
// What one plan varies more than another is known by blocks of many pixels. A path that a plan
// lacks a family for, and so meets once in a million samples, is a spike in a pixel, which the
// trimmed relMSE leaves out, but weighs down a whole block here. So where a single contribution is
// more than this share of all that a block has, the block is cut to the largest of the others, if
// it is among so many of the largest. On the scenes of assets/ path tracing's forecast is then
// nearest to what it has after ten seconds. A small caustic that path tracing hardly finds is no
// spike: light subpaths meet it many times in each block.
constexpr double spike = 0.5;
constexpr double capped_blocks = 0.03;
// A plan must be so much better than those before it; and so much than path tracing, of which too
// much is expected mostly: its error comes from paths that other strategies found.
constexpr double margin = 0.95, margin_over_path_tracing = 0.9;
// No plan is believed to have less of the full one's error than this: a difference of noisy sums.
constexpr double least_error = 0.02;
// Prices, in units of a camera walk's ray: from a profile, rounded, and held against what leaving
// out a family saves on the scenes of assets/: a tenth of the render time off at most, mostly less.
struct Prices {
    double sample = 0.5, camera_ray = 1, next_event = 0.7, second_next_event = 1.3;
    double subpath = 0.4, light_ray = 0.9, light_tracing = 0.75, connection = 0.65;
};

// Next event to a single lamp needs no help with direct light (direct_share()).
bool splats_direct(const Scene& scene, const Families& f) {
    return direct_share(scene, f) > least_direct_share;
}

// Plans that make every path the full one makes.
Candidates find_candidates(const Scene& scene, const Estimator& full) {
    const SceneFeatures features = scene_features(scene);
    const auto gaps = [&](const Families& f) {
        return not_covered(features, f, full.direct_lamps);
    };
    const Families& f = full.families;
    const std::vector<std::string> unavoidable = gaps(f);
    Candidates c;
    c.splats_direct = splats_direct(scene, f);
    const Families own{f.emitter_hit, f.next_event, false, false};
    if (gaps(own) == unavoidable) c.add(own, 0);
    if (f.light_tracing) {
        const Families tracing{f.emitter_hit, f.next_event, true, false};
        if (gaps(tracing) == unavoidable)
            for (const int quarters : {4, 2, 1, 8}) c.add(tracing, quarters);
    }
    if (f.connection) {
        const Families connecting{f.emitter_hit, f.next_event, false, true};
        if (f.light_tracing && gaps(connecting) == unavoidable) c.add(connecting, 4);
        for (const int quarters : {4, 2, 1}) c.add(f, quarters);
        if (f.light_tracing) c.add(f, 8);
    }
    c.end(f);
    return c;
}

// Without the largest so many.
double trimmed_sum(std::vector<double>& values, size_t trimmed) {
    std::sort(values.begin(), values.end());
    double sum = 0;
    for (size_t i = 0; i + trimmed < values.size(); ++i) sum += values[i];
    return sum;
}

// What a plan varies more than a measured one in a block.
struct Excess {
    double value = 0;
    bool spike = false;
};

// With the spikes among the largest so many cut to the largest of the others.
double capped_sum(std::vector<Excess>& excess, size_t capped) {
    std::sort(excess.begin(), excess.end(),
              [](const Excess& a, const Excess& b) { return a.value < b.value; });
    const size_t first = excess.size() - capped;
    double sum = 0;
    for (size_t i = 0; i < excess.size(); ++i)
        sum += i >= first && excess[i].spike ? excess[first - 1].value : excess[i].value;
    return sum;
}

struct Relative {
    std::vector<double> per_sample;  // of a block: from sums to means per pixel and pass
    std::vector<double> scale;       // 1 / (image^2 + 0.01 mean^2)
};

Relative relative_scales(const PilotSums& r, const Grid& grid) {
    std::vector<double> pixels(r.blocks.size(), 0.0);
    for (int y = grid.crop.y0; y < grid.crop.y1; ++y)
        for (int x = grid.crop.x0; x < grid.crop.x1; ++x) ++pixels[grid.block(x, y)];
    Relative relative;
    double mean = 0;
    for (const BlockSums& b : r.blocks) mean += b.image / pilot_samples;
    for (size_t b = 0; b < r.blocks.size(); ++b) {
        const double per_sample = double(grid.crop.area()) / (pilot_samples * pixels[b]);
        const double denominator = sqr(r.blocks[b].image * per_sample) + 0.01 * sqr(mean);
        relative.per_sample.push_back(per_sample);
        relative.scale.push_back(denominator > 0 ? 1 / denominator : 0);
    }
    return relative;
}

// What a group varies per sample in a pixel of a block, by the moments of a plan.
double variance_in(const BlockSums& sums, int plan, int g, const Plan& p, double per_sample) {
    const Family family{std::uint8_t(g / lengths)};
    if (!p.families.has(family)) return 0;
    const double square = sums.second[g][plan] * per_sample,
                 mean = sqr(sums.first[g][plan] * per_sample);
    // Splats are so rare in a pixel that E[x]^2 is nothing beside E[x^2].
    if (family == Family::light_tracing) return square;
    // Every pixel's samples take turns in meeting a light subpath: chance decides about a
    // connection's value, not whether there is one.
    if (family == Family::connection) return square - mean / connection_share(p);
    // Samples of direct light from one surface have it in common: measured_shares() knows.
    if (g == group_of(Family::next_event, 2)) return square - mean / p.direct_samples;
    return square - mean;
}

// What is measured, as it is: a plan of the pilot's samples, with or without the second ones of
// direct light.
struct Measured {
    int plan = 0;
    Moments shares;    // of what moments say
    double error = 0;  // the relative squared error per sample, splats included
};

// Over what moments say, the variance of what a camera sample gathers is lower by stratification
// and higher because what one subpath, or next event from one surface, finds comes together: by
// group. Light that a longer walk hits by chance stays where it is: of that a plan has more where
// others would have found it better, and it comes in spikes that nothing smooths.
Moments measured_shares(const PilotSums& r, const Relative& relative, const Candidates& c, int kind,
                        int plan) {
    Moments measured{}, expected{}, shares;
    double together = 0, apart = 0;
    for (const PixelVariances& pixel : r.pixels) {
        const GatheredVariances& v = pixel.of[kind];
        for (int g = 0; g < groups; ++g) {
            measured[g] += v.groups[g] * relative.scale[pixel.block];
            apart += v.groups[g] * relative.scale[pixel.block];
        }
        together += v.all * relative.scale[pixel.block];
    }
    for (size_t b = 0; b < r.blocks.size(); ++b)
        for (int g = 0; g < groups; ++g)
            expected[g] +=
                relative.scale[b] / relative.per_sample[b] *
                variance_in(r.blocks[b], plan, g, c.plans[plan], relative.per_sample[b]) /
                pilot_passes;
    shares.fill(1);
    for (int g = 0; g < groups; ++g) {
        if (Family(g / lengths) == Family::light_tracing || !(expected[g] > 0)) continue;
        const bool by_chance = g > group_of(Family::emitter_hit, 2) && g < lengths;
        shares[g] = std::clamp(measured[g] / expected[g], by_chance ? 1 : 0.05, 4.0);
        shares[g] *= together / apart;
    }
    return shares;
}

// `kind` as in PixelVariances.
Measured measure(const PilotSums& r, const Relative& relative, const Candidates& c, int kind) {
    const int plan = kind == 0 ? c.full() : c.sampled();
    Measured m{plan, measured_shares(r, relative, c, kind, plan), 0};
    std::vector<double> squares;
    for (const PixelVariances& v : r.pixels)
        squares.push_back(v.of[kind].all * relative.scale[v.block]);
    m.error = pilot_passes * trimmed_sum(squares, size_t(trimmed_share * double(squares.size())));
    for (size_t b = 0; b < r.blocks.size(); ++b)
        for (int k = 0; k < lengths; ++k)
            m.error += r.blocks[b].second[group_of(Family::light_tracing, k + 2)][m.plan] *
                       relative.scale[b];
    return m;
}

// What a plan varies more than the measured one, over all blocks.
double excess_of(const PilotSums& r, const Relative& relative, const Candidates& c,
                 const Measured& m, int plan) {
    const bool lacks_a_family = c.plans[plan].families != c.plans[m.plan].families;
    std::vector<Excess> excess;
    for (size_t b = 0; b < r.blocks.size(); ++b) {
        const BlockSums& sums = r.blocks[b];
        const auto variance = [&](int i, int g) {
            return variance_in(sums, i, g, c.plans[i], relative.per_sample[b]);
        };
        double sum = 0, squares = 0;
        for (int g = 0; g < groups; ++g) {
            sum += m.shares[g] * (variance(plan, g) - variance(m.plan, g));
            squares += sums.second[g][plan];
        }
        excess.push_back({relative.scale[b] / relative.per_sample[b] * sum,
                          lacks_a_family && sums.largest[plan] > spike * squares});
    }
    return capped_sum(excess, size_t(capped_blocks * double(excess.size())));
}

// The relative squared error of each plan, per sample of a pixel; the last element is that of the
// full one. What the pilot's own camera samples vary is measured as it is, all that comes together
// included; what another plan has more follows from moments.
std::vector<double> relative_errors(const PilotSums& r, const Grid& grid, const Candidates& c) {
    const Relative relative = relative_scales(r, grid);
    const std::array<Measured, 2> measured{measure(r, relative, c, 0), measure(r, relative, c, 1)};
    std::vector<double> errors;
    for (int i = 0; i <= c.full(); ++i) {
        const Measured& m = measured[c.plans[i].direct_samples - 1];
        const double more = excess_of(r, relative, c, m, i);
        errors.push_back(std::max(least_error * m.error, m.error + more) / pilot_samples);
    }
    return errors;
}

// Of all samples, in rays.
double cost_of(const Plan& p, const PilotSums& n) {
    const Prices price;
    std::array<double, 4> rays{};
    for (int edges = 1; strategy_count(edges) < n.shadow_rays.size(); ++edges)
        for (int s = 1; s <= edges + 1; ++s) {
            const Strategy k{s, edges + 1 - s};
            if (k == Strategy{1, 2} && !p.splats_direct) continue;
            rays[size_t(family_of(k))] += double(n.shadow_rays[strategy_index(k)]);
        }
    // The pilot's are two for each surface.
    const double direct = double(n.shadow_rays[strategy_index({2, 1})]) / 2;
    const double camera = price.sample * pilot_samples +
                          price.camera_ray * double(n.camera.closest) +
                          price.next_event * (rays[size_t(Family::next_event)] - direct) +
                          price.second_next_event * (p.direct_samples - 1) * direct;
    double light = price.subpath * pilot_samples + price.light_ray * double(n.light.closest);
    if (p.families.light_tracing)
        light += price.light_tracing * rays[size_t(Family::light_tracing)];
    double connections = 0;
    if (p.families.connection) connections = price.connection * rays[size_t(Family::connection)];
    return camera + light_share(p) * light + connection_share(p) * connections;
}

// Plans with connections end their walks by roulette earlier than others (make_estimator), which
// changes noise and cost alike: each kind is measured with its own, from the same random numbers.
struct Run {
    PilotSums sums;
    std::vector<double> errors;  // relative_errors()
};
std::optional<Run> run_pilot(const Estimator& e, const Candidates& candidates, int threads,
                             const RenderControl* control) {
    const Grid grid(e.crop);
    std::optional<PilotSums> sums = sample_pilot(e, grid, candidates, threads, control);
    if (!sums) return {};
    Run run{std::move(*sums), {}};
    run.errors = relative_errors(run.sums, grid, candidates);
    return run;
}

// Of a plan by a run that it belongs to, against the full plan by its own run.
PlanForecast forecast_of(const Candidates& candidates, int i, const Run& run, const Plan& full,
                         const Run& of_full) {
    PlanForecast f{candidates.plans[size_t(i)]};
    f.cost = cost_of(f.plan, run.sums) / cost_of(full, of_full.sums);
    // A black image has no error to compare: the cheapest plan then.
    f.error = of_full.errors.back() > 0 ? run.errors[size_t(i)] / of_full.errors.back() : 1;
    if (!(f.error > 0)) f.error = std::numeric_limits<double>::infinity();
    return f;
}

// Whether no plan without connections comes near the others, whatever roulette it has: its own made
// error x cost 0.75 to 1.4 times as large on the scenes of assets/.
bool connections_win(const Candidates& candidates, const Run& run, const Plan& full) {
    double with = std::numeric_limits<double>::infinity(), without = with;
    for (int i = 0; i < candidates.count; ++i) {
        const PlanForecast f = forecast_of(candidates, i, run, full, run);
        double& best = f.plan.families.connection ? with : without;
        best = std::min(best, f.time());
    }
    return without > 2 * with;
}

}  // namespace

const PlanForecast& PlanDecision::chosen() const {
    return *std::find_if(forecasts.begin(), forecasts.end(),
                         [&](const PlanForecast& f) { return f.plan == plan; });
}

std::optional<PlanDecision> decide_plan(const Scene& scene, const CameraDescription& camera,
                                        const RenderSettings& settings, int threads,
                                        const RenderControl* control) {
    const auto start = std::chrono::steady_clock::now();
    make_estimator(scene, camera, settings);  // throws what the pilot does not look at
    const Estimator e = pilot_estimator(scene, camera, settings);
    const Candidates candidates = find_candidates(scene, e);
    const Plan full = candidates.plans[candidates.full()];
    PlanDecision decision{candidates.count > 0 ? candidates.plans[0] : full, {}};
    // Strategies that were asked for one by one are there whatever they cost.
    if (!settings.only.empty()) decision.plan = full;
    if (candidates.count < 2 || !settings.only.empty()) {
        decision.forecasts.push_back({decision.plan});
        return decision;
    }
    Estimator unconnected = e;
    unconnected.roulette = roulette_of(Families{true, true, true, false});
    const std::optional<Run> a = run_pilot(e, candidates, threads, control);
    if (!a) return {};
    // Where the full plan does not connect either, it would be the same run again.
    const bool same = unconnected.roulette == e.roulette;
    const std::optional<Run> b = same || connections_win(candidates, *a, full)
                                     ? a
                                     : run_pilot(unconnected, candidates, threads, control);
    if (!b) return {};
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < candidates.count; ++i) {
        const bool connects = candidates.plans[size_t(i)].families.connection;
        const PlanForecast f = forecast_of(candidates, i, connects ? *a : *b, full, *a);
        const bool path_tracing = !decision.plan.families.needs_light_subpaths();
        if (f.time() < (path_tracing ? margin_over_path_tracing : margin) * best) {
            best = f.time();
            decision.plan = f.plan;
        }
        decision.forecasts.push_back(f);
    }
    decision.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return decision;
}

std::string describe(const Plan& plan) {
    const Families& f = plan.families;
    const char* twice = plan.direct_samples > 1 ? ", direct light twice" : "";
    if (!f.needs_light_subpaths()) return fmt::format("path tracing, no light subpaths{}", twice);
    std::string what = "all families";
    if (!f.connection) what = "path and light tracing, no connections";
    if (!f.light_tracing) what = "connections, no light tracing";
    constexpr const char* numbers[] = {"no", "a quarter of a", "half a", "", "one", "", "", "",
                                       "two"};
    return fmt::format("{}, {} light subpath{} per pixel{}{}", what, numbers[plan.light_quarters],
                       plan.light_quarters > 4 ? "s" : "",
                       plan.splats_direct ? "" : ", direct light by next event", twice);
}

std::string describe(const PlanDecision& decision) {
    const PlanForecast& f = decision.chosen();
    if (decision.forecasts.size() < 2) return describe(f.plan) + ": there is no other to choose";
    if (f.cost == 1 && f.error == 1)
        return describe(f.plan) + ": plain bdpt, nothing faster is expected";
    const double percent = 100 * f.time();
    return fmt::format("{}; expected {:.{}f} % of the time of plain bdpt for the same error",
                       describe(f.plan), percent, percent < 9.95 ? 1 : 0);
}

std::optional<PlanDecision> choose_plan(const Scene& scene, const CameraDescription& camera,
                                        RenderSettings& settings, int threads) {
    if (settings.technique != Technique::automatic || settings.plan) return {};
    const std::clock_t cpu = std::clock();
    std::optional<PlanDecision> decision = decide_plan(scene, camera, settings, threads);
    decision->cpu_seconds = double(std::clock() - cpu) / CLOCKS_PER_SEC;
    settings.plan = decision->plan;
    return decision;
}

}  // namespace midway
