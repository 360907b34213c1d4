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
    return {{path, 0},    {tracing, 1},    {tracing, 2}, {tracing, 4},
            {tracing, 8}, {connecting, 4}, {{}, 4},      {{}, 8}};
}

// The trimmed relative squared error per sample, of independent samples.
double measured_error(const AgreementScene& scene, const Plan& plan, std::uint64_t passes) {
    RenderSettings s = planned(scene, plan, 48);
    s.sampler = SamplerKind::independent;
    ProgressiveRenderer r(scene.scene, scene.camera, s, {.threads = 1});
    r.render_passes(passes);
    const Image image = r.image(), variance = r.variance();
    double mean = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) mean += luminance(image.at(x, y)) / (48.0 * 48);
    std::vector<double> errors;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x)
            errors.push_back(luminance(variance.at(x, y)) * double(passes) /
                             (sqr(double(luminance(image.at(x, y)))) + 0.01 * sqr(mean)));
    std::sort(errors.begin(), errors.end());
    double sum = 0;
    for (size_t i = 0; i + 3 < errors.size(); ++i) sum += errors[i];
    return sum;
}

// Relative to the full plan. Over 20 seeds of the render and of the pilot the quotient of forecast
// and measured error had the spread that is printed; the bounds are six times as far. Found to
// fail: light tracing's density not scaled by its subpaths, the pilot's strategy counted in plans
// that lack it, roulette of the wrong kind.
TEST(Pilot, ForecastsTheErrorsThatPlansHave) {
    for (const char* name : {"area", "rough_metal", "sky_map"}) {
        const AgreementScene scene = make_agreement_scene(name);
        RenderSettings s = planned(scene, {}, 48);
        s.plan.reset();
        const PlanDecision d = *decide_plan(*scene.scene, scene.camera, s, 1);
        ASSERT_GE(d.forecasts.size(), 7u);
        const double full = measured_error(scene, {{}, 4}, 256);
        for (const PlanForecast& f : d.forecasts) {
            const double measured = measured_error(scene, f.plan, 256) / full;
            std::printf("%-12s %-80s forecast %.3f measured %.3f\n", name, describe(f.plan).c_str(),
                        f.error, measured);
            EXPECT_NEAR(std::log(f.error / measured), 0, 0.25) << name << " " << describe(f.plan);
        }
    }
}

// Whatever a plan leaves out, the image is the same: by blocks and in the mean, at 1e-4 in all.
TEST(Plans, HaveTheSameMean) {
    const std::vector<Plan> plans = all_plans();
    for (const char* name : {"five_lights", "rough_glass"}) {
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
