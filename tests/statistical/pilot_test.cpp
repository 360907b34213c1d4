// What `auto` decides by: that the pilot's forecast of a plan's error is what a render with that
// plan has, and that every plan has the same mean.
#include "render/pilot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/pilot_sums.h"
#include "support/agreement.h"

namespace midway::test {
namespace {

RenderSettings planned(const AgreementScene& scene, const Plan& plan, int size) {
    RenderSettings s;
    s.technique = Technique::automatic;
    s.plan = plan;
    s.width = s.height = size;
    s.max_bounces = scene.max_bounces;
    s.seed = 77;
    return s;
}

std::vector<Plan> all_plans() {
    const Families path{true, true, false, false}, tracing{true, true, true, false};
    const Families connecting{true, true, false, true};
    return {{path, 0},
            {tracing, 1},
            {tracing, 2},
            {tracing, 4},
            {tracing, 8},
            {connecting, 4},
            {{}, 1},
            {{}, 2},
            {{}, 4},
            {{}, 8},
            // Direct light by next event alone.
            {{}, 4, false},
            {{}, 1, false},
            {tracing, 2, false},
            // Direct light sampled twice.
            {path, 0, true, 2},
            {tracing, 2, true, 2},
            {{}, 4, true, 2},
            {{}, 1, false, 2}};
}

// The trimmed relative squared error per sample of renders of sixteen passes, over sixteen seeds.
double measured_error(const AgreementScene& scene, const Plan& plan, SamplerKind sampler) {
    constexpr int size = 48, passes = 16, seeds = 16;
    RenderSettings s = planned(scene, plan, size);
    s.sampler = sampler;
    std::vector<double> variances(size * size), luminances(size * size);
    for (; s.seed < 77 + seeds; ++s.seed) {
        ProgressiveRenderer r(scene.scene, scene.camera, s, {.threads = 1});
        r.render_passes(passes);
        const Image image = r.image(), variance = r.variance();
        for (int i = 0; i < size * size; ++i) {
            luminances[i] += luminance(image.at(i % size, i / size)) / seeds;
            variances[i] += luminance(variance.at(i % size, i / size)) * passes / seeds;
        }
    }
    double mean = 0;
    for (const double l : luminances) mean += l / (size * size);
    std::vector<double> errors;
    for (int i = 0; i < size * size; ++i)
        errors.push_back(variances[i] / (sqr(luminances[i]) + 0.01 * sqr(mean)));
    std::sort(errors.begin(), errors.end());
    double sum = 0;
    for (size_t i = 0; i + 3 < errors.size(); ++i) sum += errors[i];
    return sum;
}

// By group of the pilot.
using GroupMeans = std::array<RunningMean, groups>;

// What strategies contribute to renders with a plan: luminance per pixel and pass, over seeds.
GroupMeans rendered_means(const AgreementScene& scene, const Plan& plan, int size) {
    constexpr int passes = 4, seeds = 24;
    RenderSettings s = planned(scene, plan, size);
    s.exponents = {1};  // as the pilot weighs
    GroupMeans means;
    for (; s.seed < 77 + seeds; ++s.seed) {
        ProgressiveRenderer r(scene.scene, scene.camera, s, {.threads = 1, .statistics = true});
        r.render_passes(passes);
        Moments sums{};
        for (const StrategyStatistics& k : r.statistics().strategies)
            sums[group_of(family_of(k.strategy), k.strategy.edges())] += k.energy;
        for (int g = 0; g < groups; ++g) means[g].add(sums[g]);
    }
    return means;
}

// The same as the pilot's sums have it, for each plan, over pilots with seeds of their own.
std::vector<GroupMeans> pilot_means(const AgreementScene& scene, const Candidates& candidates,
                                    int size) {
    constexpr int seeds = 24;
    RenderSettings s = planned(scene, {}, size);
    s.plan.reset();
    Estimator e = pilot_estimator(*scene.scene, scene.camera, s);
    std::vector<GroupMeans> means(size_t(candidates.count));
    for (e.seed = 177; e.seed < 177 + seeds; ++e.seed) {
        const PilotSums sums = *sample_pilot(e, Grid(e.crop), candidates, 1, nullptr);
        for (size_t i = 0; i < means.size(); ++i)
            for (int g = 0; g < groups; ++g) {
                double sum = 0;
                for (const BlockSums& b : sums.blocks) sum += b.first[g][i];
                means[i][g].add(sum / pilot_samples);
            }
    }
    return means;
}

// From the full plan's samples the pilot tells what each family would contribute in every other
// plan, by length of the path: the same as renders with that plan have. At 1e-4 in all. Found to
// fail: light tracing or connections not scaled by how many there are, a family's densities counted
// in plans that lack it, the pilot's own strategy counted in all.
TEST(Pilot, SharesLightAmongFamiliesAsPlansDo) {
    constexpr int size = pilot_columns;  // so that it samples every pixel, and all alike
    static_assert(pilot_columns == pilot_rows);
    const Families path{true, true, false, false}, tracing{true, true, true, false};
    const Families connecting{true, true, false, true}, all;
    Candidates candidates;
    candidates.splats_direct = true;  // whose densities are the pilot's own
    candidates.add(path, 0);
    for (const int quarters : {1, 4, 8}) candidates.add(tracing, quarters);
    candidates.add(connecting, 4);
    for (const int quarters : {1, 2, 4, 8}) candidates.add(all, quarters);
    candidates.end(all);
    const std::vector<const char*> names = {"area", "rough_metal", "sky_map"};
    const std::int64_t comparisons = std::int64_t(names.size()) * candidates.count * groups;
    const double limit = -normal_quantile(sidak_level(1e-4, comparisons) / 2);
    for (const char* name : names) {
        const AgreementScene scene = make_agreement_scene(name);
        const std::vector<GroupMeans> told = pilot_means(scene, candidates, size);
        for (int i = 0; i < candidates.count; ++i) {
            const Plan& plan = candidates.plans[size_t(i)];
            const GroupMeans rendered = rendered_means(scene, plan, size);
            for (int g = 0; g < groups; ++g) {
                const RunningMean &a = told[size_t(i)][g], &b = rendered[g];
                if (a.mean == 0 && b.mean == 0) continue;
                const double z = welch_z(a, b);
                EXPECT_LE(std::abs(z), limit) << fmt::format(
                    "{}, {}, family {} length {}: the pilot has {:.6g}, renders {:.6g}", name,
                    describe(plan), g / lengths, g % lengths, a.mean, b.mean);
            }
        }
    }
}

// Relative to the full plan. Over 20 other times sixteen seeds of the renders the quotient of
// forecast and measured error had a spread (one standard deviation of its logarithm) of at most
// 0.03; with Sobol numbers, where a path tracer finds what rough metal casts, 0.07. It is at most
// 0.13 away from none with these seeds, 0.16 on rough metal with Sobol numbers: a plan without
// light tracing is believed to be better than it is. Bounds: four spreads beyond or more, 1e-4.
// Found to fail: light tracing or connections not scaled by how many there are, the pilot's
// strategy counted in plans that lack it, roulette of the wrong kind, second samples of direct
// light counted where a plan has none, or nowhere.
TEST(Pilot, ForecastsTheErrorsThatPlansHave) {
    for (const std::string name : {"area", "rough_metal", "sky_map"})
        for (const SamplerKind sampler : {SamplerKind::independent, SamplerKind::sobol}) {
            const AgreementScene scene = make_agreement_scene(name);
            RenderSettings s = planned(scene, {}, 48);
            s.plan.reset();
            s.sampler = sampler;
            const bool spiky = name == "rough_metal" && sampler == SamplerKind::sobol;
            const double bound = spiky ? 0.5 : 0.25;
            const PlanDecision d = *decide_plan(*scene.scene, scene.camera, s, 1);
            ASSERT_GE(d.forecasts.size(), 18u);
            const double full = measured_error(scene, {{}, 4}, sampler);
            for (const PlanForecast& f : d.forecasts) {
                const double measured = measured_error(scene, f.plan, sampler) / full;
                std::printf("%-12s %-12s %-80s forecast %.3f measured %.3f\n", name.c_str(),
                            std::string(to_string(sampler)).c_str(), describe(f.plan).c_str(),
                            f.error, measured);
                EXPECT_NEAR(std::log(f.error / measured), 0, bound)
                    << name << " " << describe(f.plan);
            }
        }
}

// In a wide view what a metal ball casts lies in few blocks of the image. Spikes in few blocks are
// cut, but this is none: light subpaths meet it all the time, where a path tracer waits for it.
// Over 20 other seeds of the pilot path tracing's error was believed to be 20 to 396 times that of
// the full plan, with a spread of 0.8 of its logarithm around 100: a bound of 4 lies four spreads
// away (3e-5). Found to fail: blocks cut whatever they hold, which tells 0.65 and chooses a path
// tracer.
TEST(Pilot, ASmallCausticIsNoSpike) {
    AgreementScene scene = make_agreement_scene("smooth_metal");
    scene.camera.yfov = 2.8;
    RenderSettings s = planned(scene, {}, 256);
    s.plan.reset();
    const PlanDecision d = *decide_plan(*scene.scene, scene.camera, s, 1);
    const PlanForecast& path_tracing = d.forecasts.front();
    ASSERT_FALSE(path_tracing.plan.families.needs_light_subpaths());
    EXPECT_GT(path_tracing.error, 4);
    EXPECT_TRUE(d.plan.families.light_tracing);
}

// Whatever a plan leaves out, the image is the same: by blocks and in the mean, at 1e-4 in all.
TEST(Plans, HaveTheSameMean) {
    const std::vector<Plan> plans = all_plans();
    for (const char* name : {"five_lights", "rough_glass", "area"}) {
        const AgreementScene scene = make_agreement_scene(name);
        for (const Plan& plan : plans) {
            if (!families_cover(scene, plan.families)) continue;
            Effort effort;
            effort.batches = 48;
            const std::string told =
                disagreement(scene, planned(scene, plan, 24), planned(scene, {{}, 4}, 24), effort,
                             2 * static_cast<int>(plans.size()));
            EXPECT_EQ("", told) << name << ": " << describe(plan);
        }
    }
}

}  // namespace
}  // namespace midway::test
