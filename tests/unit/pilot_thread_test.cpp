// A plan does not depend on threads, seeds or who asks, and rendering with it is rendering with its
// families.
#include <gtest/gtest.h>

#include "render/pilot.h"
#include "support/scenes.h"

namespace midway::test {
namespace {

SceneDescription lit_room() {
    SceneDescription s;
    add(s, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(vec3(0.6f)));
    add(s, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    add(s, make_icosphere({0.5f, 0.5f, 0}, 0.5f, 2, false, true), metal(0.3f));
    return s;
}

CameraDescription eye() { return camera_at({0, 1, 4}, {0, 0.5f, 0}, 0.8); }

RenderSettings automatic(int size = 16) { return settings(Technique::automatic, size, 4); }

FilmWords film_of(const std::shared_ptr<const Scene>& scene, const RenderSettings& s) {
    ProgressiveRenderer r(scene, eye(), s, {.threads = 2});
    r.render_passes(3);
    return r.film().words();
}

TEST(Plan, IsTheSameForAnyThreadsAndSeed) {
    const auto scene = build(lit_room());
    const PlanDecision one = *decide_plan(*scene, eye(), automatic(), 1);
    ASSERT_GE(one.forecasts.size(), 7u);
    for (const int threads : {2, 5}) {
        RenderSettings s = automatic();
        s.seed = static_cast<std::uint64_t>(threads);
        s.exponents = {0, 2};
        const PlanDecision other = *decide_plan(*scene, eye(), s, threads);
        EXPECT_EQ(one.plan, other.plan);
        for (size_t i = 0; i < one.forecasts.size(); ++i) {
            EXPECT_EQ(one.forecasts[i].cost, other.forecasts[i].cost);
            EXPECT_EQ(one.forecasts[i].error, other.forecasts[i].error);
        }
    }
}

TEST(Plan, IsDecidedOnceAndKept) {
    const auto scene = build(lit_room());
    RenderSettings s = automatic();
    const auto decision = choose_plan(*scene, eye(), s, 2);
    ASSERT_TRUE(decision && s.plan);
    EXPECT_EQ(decision->plan, *s.plan);
    EXPECT_FALSE(choose_plan(*scene, eye(), s, 2));
    RenderSettings fixed = settings(Technique::bdpt, 16, 4);
    EXPECT_FALSE(choose_plan(*scene, eye(), fixed, 2));
    EXPECT_FALSE(fixed.plan);
}

TEST(Plan, WithoutLightSubpathsIsThePathTracer) {
    const auto scene = build(lit_room());
    RenderSettings s = automatic();
    s.plan = Plan{{true, true, false, false}, 0};
    EXPECT_TRUE(film_of(scene, s) == film_of(scene, settings(Technique::path, 16, 4)));
    s.plan = Plan{{}, 4};
    EXPECT_TRUE(film_of(scene, s) == film_of(scene, settings(Technique::bdpt, 16, 4)));
}

TEST(Plan, CoversWhatAllFamiliesCover) {
    // What a point lamp casts through smooth glass is found by light tracing alone, where no body
    // beyond it can be met by a connection.
    SceneDescription d;
    add(d, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(vec3(0.6f)));
    add(d, make_icosphere({0, 0.7f, 0}, 0.5f, 2, false, true), glass(0));
    d.lights = {point_light({1, 2, 1}, 1)};
    const auto scene = build(d);
    const PlanDecision decision = *decide_plan(*scene, eye(), automatic(), 2);
    ASSERT_FALSE(decision.forecasts.empty());
    for (const PlanForecast& f : decision.forecasts) EXPECT_TRUE(f.plan.families.light_tracing);
}

TEST(Plan, TracesAsManyLightSubpathsAsItSays) {
    const auto scene = build(lit_room());
    for (const auto& [quarters, expected] : {std::pair{1, 64}, {2, 128}, {4, 256}, {8, 512}}) {
        RenderSettings s = automatic();
        s.plan = Plan{{true, true, true, false}, quarters};
        ProgressiveRenderer r(scene, eye(), s, {.threads = 2});
        r.render_passes(2);
        EXPECT_EQ(2u * expected, r.statistics().rays.light_paths);
    }
}

TEST(Plan, EndsWhereItIsStopped) {
    const auto scene = build(lit_room());
    RenderControl control;
    control.cancel();
    EXPECT_FALSE(decide_plan(*scene, eye(), automatic(), 2, &control));
}

}  // namespace
}  // namespace midway::test
