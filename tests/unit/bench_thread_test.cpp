// `midway bench`: timings decide nothing here; what is counted must be right.
#include <gtest/gtest.h>

#include <numeric>

#include "report/bench.h"
#include "support/scenes.h"

namespace midway::test {
namespace {

TEST(Bench, MedianHasAnIntervalOfItsOrderStatistics) {
    const Middle m = middle_of({9, 1, 8, 2, 7, 3, 6, 4, 5});
    EXPECT_EQ(m.median, 5);
    // Of nine values the second and the last but one: 96 % by the binomial distribution.
    EXPECT_EQ(m.low, 2);
    EXPECT_EQ(m.high, 8);
    EXPECT_EQ(middle_of({4, 2}).median, 3);
    EXPECT_EQ(middle_of({}).median, 0);
}

SceneDescription room() {
    SceneDescription d;
    add(d, make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), lambert(vec3(0.7f)));
    add(d, make_quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}), lambert(vec3(0.5f)));
    add(d, make_quad({-0.2f, 1.9f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}), lamp(vec3(5)));
    return d;
}

CameraDescription eye() { return camera_at({0, 1, 3}, {0, 0.7f, 0}, 0.8); }

TEST(Bench, ALogHoldsTheRaysThatWereTraced) {
    const auto scene = build(room());
    const CameraDescription camera = eye();
    const RenderSettings s = settings(Technique::bdpt, 24, 16);
    RayLog log;
    log.limit = 1'000'000;
    auto watched = std::make_shared<Scene>(*scene);
    watched->accel = std::make_shared<Accel>(*scene->accel, log);
    ProgressiveRenderer r(watched, camera, s, {.threads = 1});
    r.render_passes(2);
    const RayCounts rays = r.statistics().rays;
    const auto closest = std::count_if(log.rays.begin(), log.rays.end(),
                                       [](const RayLog::Entry& e) { return e.closest; });
    EXPECT_EQ(std::uint64_t(closest), rays.closest);
    EXPECT_EQ(log.rays.size(), rays.closest + rays.shadow);
    EXPECT_EQ(log.missed, 0u);
    EXPECT_EQ(scene->accel->replay(log, {scene.get()}), scene->accel->replay(log, {scene.get()}));
    EXPECT_GT(scene->accel->replay(log, {scene.get()}), rays.shadow / 10);

    RayLog small;
    small.limit = 10;
    watched->accel = std::make_shared<Accel>(*scene->accel, small);
    ProgressiveRenderer(watched, camera, s, {.threads = 1}).render_passes(2);
    EXPECT_EQ(small.rays.size(), 10u);
    EXPECT_EQ(small.missed + 10, log.rays.size());
}

TEST(Bench, SharesAreOfOneWholeAndCountsAreMeans) {
    const auto scene = build(room());
    const RenderSettings s = settings(Technique::bdpt, 32, 16);
    BenchOptions o;
    o.threads = 2;
    o.rounds = 3;
    o.seconds = 0.01;
    o.watch_seconds = 0.2;
    const BenchResult r = run_bench(scene, eye(), s, o);
    EXPECT_NEAR(std::accumulate(r.shares.begin(), r.shares.end(), 0.0), 1, 1e-12);
    EXPECT_GT(r.shares[size_t(Work::rays)], 0);
    EXPECT_GT(r.shares[size_t(Work::shading)], 0);
    EXPECT_EQ(r.per_pass.camera_paths, 32u * 32u);
    EXPECT_EQ(r.per_pass.light_paths, 32u * 32u);
    EXPECT_TRUE(r.whole_log);
    EXPECT_GT(r.limit_ratio.median, 0);
    EXPECT_LE(r.limit_ratio.low, r.limit_ratio.median);
    ASSERT_EQ(r.scaling.size(), 2u);
    EXPECT_EQ(r.scaling.back().threads, 2);
    EXPECT_GT(r.samples_per_second, 0);
}

}  // namespace
}  // namespace midway::test
