// A plan does not depend on threads, seeds or who asks, and rendering with it is rendering with its
// families.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

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
        for (const bool connecting : {false, true}) {
            RenderSettings s = automatic();
            s.plan = Plan{{true, true, true, connecting}, quarters};
            ProgressiveRenderer r(scene, eye(), s, {.threads = 2});
            r.render_passes(2);
            EXPECT_EQ(2u * expected, r.statistics().rays.light_paths);
        }
    }
}

// A point lamp is seen from a place or not, however often next event asks: twice the rays from the
// first surface, as many from all others.
TEST(Plan, SamplesDirectLightAsOftenAsItSays) {
    SceneDescription d;
    add(d, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(vec3(0.6f)));
    add(d, make_icosphere({0, 0.7f, 0}, 0.5f, 2, false, true), lambert(vec3(0.6f)));
    d.lights = {point_light({1, 2, 1}, 1)};
    const auto scene = build(d);
    const auto rays = [&](int direct_samples) {
        RenderSettings s = automatic();
        s.plan = Plan{{true, true, false, false}, 0, true, direct_samples};
        ProgressiveRenderer r(scene, eye(), s, {.threads = 2, .statistics = true});
        r.render_passes(4);
        std::pair<std::uint64_t, std::uint64_t> sum{};
        for (const StrategyStatistics& k : r.statistics().strategies)
            (k.strategy == Strategy{2, 1} ? sum.first : sum.second) += k.rays;
        return sum;
    };
    const auto once = rays(1), twice = rays(2);
    EXPECT_GT(once.first, 300u);
    EXPECT_GT(once.second, 0u);
    EXPECT_EQ(2 * once.first, twice.first);
    EXPECT_EQ(once.second, twice.second);
    EXPECT_THROW(rays(0), std::invalid_argument);
    EXPECT_THROW(rays(3), std::invalid_argument);
}

// Eight passes with a subpath for a quarter of the pixels: one for each in the even passes, one in
// the odd ones, and never the same pixels together.
TEST(Plan, LetsPixelsTakeTurnsInMeetingLightSubpaths) {
    const auto scene = build(lit_room());
    RenderSettings s = automatic();
    s.plan = Plan{{}, 1};
    const Estimator e = make_estimator(*scene, eye(), s);
    EXPECT_EQ(0.25, e.connection_share);
    const auto met = [&](std::uint64_t pass) {
        std::set<std::pair<int, int>> pixels;
        std::set<std::uint64_t> subpaths;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                if (const auto i = paired_subpath(e, x, y, pass); i < e.light_subpaths) {
                    pixels.insert({x, y});
                    subpaths.insert(i);
                }
        EXPECT_EQ(64u, pixels.size());
        EXPECT_EQ(64u, subpaths.size());
        return pixels;
    };
    std::set<std::set<std::pair<int, int>>> seen;
    for (std::uint64_t first : {0, 1, 8, 9}) {
        std::set<std::pair<int, int>> all;
        for (std::uint64_t pass = first; pass < first + 8; pass += 2) {
            const auto pixels = met(pass);
            all.insert(pixels.begin(), pixels.end());
            EXPECT_TRUE(seen.insert(pixels).second);
        }
        EXPECT_EQ(256u, all.size());
    }
}

// Which pixels meet a subpath in one pass is chance, for images of any size: over 4000 seeds the
// number for a pixel has its mean within 5 standard errors (false alarm over all: 6e-5).
TEST(Plan, GivesEveryPixelTheSameChanceOfASubpath) {
    const auto scene = build(lit_room());
    for (const auto& [width, height] : {std::pair{1, 4}, {3, 1}, {5, 2}, {7, 3}, {8, 8}}) {
        RenderSettings s = automatic();
        s.plan = Plan{{}, 1};
        s.crop = PixelRect{2, 3, 2 + width, 3 + height};
        std::vector<int> counts(size_t(width * height));
        double share = 0;
        for (s.seed = 0; s.seed < 4000; ++s.seed) {
            const Estimator e = make_estimator(*scene, eye(), s);
            share = e.connection_share;
            for (int i = 0; i < width * height; ++i)
                counts[i] += paired_subpath(e, 2 + i % width, 3 + i / width, 5) < e.light_subpaths;
        }
        for (size_t i = 0; i < counts.size(); ++i)
            EXPECT_NEAR(counts[i], 4000 * share, 5 * std::sqrt(4000 * share * (1 - share)))
                << width << " x " << height << ", pixel " << i;
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
