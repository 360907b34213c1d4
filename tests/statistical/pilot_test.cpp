// What `auto` decides by: that the pilot's forecast of a plan's error is what a render with that
// plan has, and that every plan has the same mean.
#include "render/pilot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
            {tracing, 2, false}};
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

// Relative to the full plan. Over 20 other times sixteen seeds of the renders the quotient of
// forecast and measured error had a spread (one standard deviation of its logarithm) of at most
// 0.03; with Sobol numbers, where a path tracer finds what rough metal casts, 0.07. Its mean is at
// most 0.12 away from none, 0.15 with Sobol numbers, 0.19 on rough metal: blocks are capped, and a
// plan with few connections is believed to be better than it is. Bounds: three spreads beyond or
// more, so that other seeds would raise a false alarm in about one run of a hundred; these are
// fixed. Found to fail: light tracing or connections not scaled by how many there are, the pilot's
// strategy counted in plans that lack it, roulette of the wrong kind.
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
            ASSERT_GE(d.forecasts.size(), 9u);
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
