// The strategy pyramid beside a render that goes on: opening, choosing and closing lose no sample
// and change no bit. tests/run runs these cases under the thread sanitizer too.
#include <ctime>
#include <random>
#include <thread>

#include "render/live_strategies.h"
#include "render/pass_gate.h"
#include "support/watched_render.h"

namespace midway::test {
namespace {

// Whoever ends a batch, and when: the passes that were begun are whole.
TEST(PassGate, EndsBetweenPasses) {
    std::mt19937 random(1);
    int early = 0;
    for (int round = 0; round < 200; ++round) {
        constexpr std::uint64_t passes = 40, tiles = 3;
        RenderControl control;
        PassGate gate;
        std::atomic<std::uint64_t> next{0};
        std::array<std::atomic<int>, passes> done{};
        const std::uint64_t ends_at = random() % (passes * tiles);
        {
            std::vector<std::jthread> workers;
            for (int k = 0; k < 3; ++k)
                workers.emplace_back([&] {
                    for (std::uint64_t i = next++; i < passes * tiles; i = next++) {
                        if (i == ends_at) control.end_batch();
                        if (!gate.enter(i / tiles, &control)) return;
                        ++done[i / tiles];
                    }
                });
        }
        EXPECT_GE(gate.passes(), 1u);
        for (std::uint64_t p = 0; p < passes; ++p)
            EXPECT_EQ(done[p], p < gate.passes() ? int(tiles) : 0) << "round " << round;
        early += gate.passes() < passes;
    }
    EXPECT_GT(early, 150);
}

// Somebody who changes his mind all the time: once ended, a batch stays so for all its workers.
TEST(PassGate, EndsForAllWorkersOrForNone) {
    for (int round = 0; round < 50; ++round) {
        constexpr std::uint64_t passes = 400, tiles = 2;
        RenderControl control;
        PassGate gate;
        std::atomic<std::uint64_t> next{0};
        std::array<std::atomic<int>, passes> done{};
        {
            std::jthread mind([&](const std::stop_token& stop) {
                while (!stop.stop_requested()) {
                    control.end_batch();
                    control.begin_batches();
                }
            });
            std::vector<std::jthread> workers;
            for (int k = 0; k < 3; ++k)
                workers.emplace_back([&] {
                    for (std::uint64_t i = next++; i < passes * tiles; i = next++) {
                        if (!gate.enter(i / tiles, &control)) return;
                        ++done[i / tiles];
                    }
                });
        }
        for (std::uint64_t p = 0; p < passes; ++p)
            ASSERT_EQ(done[p], p < gate.passes() ? int(tiles) : 0) << "pass " << p;
    }
}

TEST(PassGate, ABatchEndsWithThePassUnderWayAndLosesNothing) {
    const LiveJob j = job(build(room()), 24);
    ProgressiveRenderer r(j.scene, j.camera, j.settings, {.threads = 2});
    ProgressiveRenderer plain(j.scene, j.camera, j.settings, {.threads = 1});
    RenderControl control;
    control.end_batch();
    EXPECT_TRUE(r.render_passes(10, {}, &control));
    EXPECT_EQ(r.passes(), 1u);
    control.begin_batches();
    EXPECT_TRUE(r.render_passes(4, {}, &control));
    EXPECT_EQ(r.passes(), 5u);
    plain.render_passes(5);
    EXPECT_EQ(r.film().words(), plain.film().words());
}

Image sum_of_tiles(const StrategySnapshot& s, bool bare) {
    Image sum(s.tile_width, s.tile_height);
    for (size_t i = 0; i < s.cells.size(); ++i) {
        const Image tile = thumbnail(s, i, bare);
        for (size_t p = 0; p < sum.pixels.size(); ++p) sum.pixels[p] += tile.pixels[p];
    }
    return sum;
}

TEST(LiveStrategies, OpenFromTheStartTheySumToTheImage) {
    Watched w;
    LiveJob j = job(build(room()), 190);
    j.settings.height = 31;
    j.settings.max_bounces = 9;
    j.stop_passes = 3;
    w.live.observe_strategies({.open = true});
    const auto s = w.wait_finished(w.live.submit(j));
    ASSERT_TRUE(s && s->strategies);
    expect_bits_of_batch(*s, j, 3);
    const StrategySnapshot& cells = *s->strategies;
    EXPECT_EQ(cells.passes, 3u);
    EXPECT_EQ(cells.box, 2);
    EXPECT_EQ(cells.lost, 0u);
    const Image sum = sum_of_tiles(cells, false);
    for (int y = 0; y < cells.tile_height; ++y)
        for (int x = 0; x < cells.tile_width; ++x) {
            dvec3 mean(0);
            int count = 0;
            for (int k = 0; k < 4; ++k) {
                const int px = 2 * x + k % 2, py = 2 * y + k / 2;
                if (px >= 190 || py >= 31) continue;
                mean += dvec3(s->images[0]->at(px, py));
                ++count;
            }
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum.at(x, y)[c], mean[c] / count, 1e-5 * mean[c]) << x << ", " << y;
        }
}

// A lamp that fills the view is bright in every sample alike.
TEST(LiveStrategies, NoiseIsNotBrightness) {
    SceneDescription d;
    add(d, make_quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), lamp(vec3(50)));
    add(d, make_quad({-0.4f, -0.4f, 0.5f}, {0.8f, 0, 0}, {0, 0.8f, 0}), lambert(vec3(0.5f)));
    d.lights = {point_light({1, 1, 3}, 1)};
    Watched w;
    LiveJob j = job(build(d), 40);
    j.stop_passes = 4;
    w.live.observe_strategies({.open = true});
    const auto s = w.wait_finished(w.live.submit(j));
    ASSERT_TRUE(s && s->strategies);
    const CellSnapshot& seen = *s->strategies->find({2, 0});
    EXPECT_GT(seen.found.second_moment, 100);
    // Only pixels at the edge of what stands before it hold both.
    EXPECT_LT(seen.variance, 0.02 * seen.found.second_moment);
    for (const CellSnapshot& c : s->strategies->cells) {
        EXPECT_LE(c.variance, c.found.second_moment) << describe(c.found.strategy);
        if (c.found.strategy.s == 1) {
            EXPECT_EQ(c.variance, c.found.second_moment);
        }
    }
}

TEST(LiveStrategies, OpeningChoosingAndClosingLoseNothing) {
    Watched w;
    LiveJob j = job(build(room()), 48);
    j.settings.exponents = {2, 0};
    const std::uint64_t number = w.live.submit(j);
    const auto before = w.wait([&](const Snapshot& s) { return s.scale == 1 && s.passes >= 3; });
    ASSERT_TRUE(before);
    EXPECT_EQ(before->strategies, nullptr);
    w.live.observe_strategies({.open = true});
    const auto opened =
        w.wait([](const Snapshot& s) { return s.strategies && s.strategies->passes > 0; });
    ASSERT_TRUE(opened);
    EXPECT_LE(opened->strategies->passes + 3, opened->passes) << "from their opening on";
    ASSERT_TRUE(opened->strategies->weighted && opened->strategies->bare);

    const Strategy chosen{2, 1};
    w.live.observe_strategies({.open = true, .selected = {chosen, {1, 2}}});
    const auto shown =
        w.wait([](const Snapshot& s) { return s.strategies && s.strategies->selected_weighted; });
    ASSERT_TRUE(shown);
    EXPECT_EQ(shown->strategies->selected.size(), 2u);
    EXPECT_EQ(shown->strategies->selected_weighted->width, 48);
    EXPECT_LT(shown->strategies->selected_passes, shown->strategies->passes);

    w.live.observe_strategies({.open = true, .exponent = 0});
    ASSERT_TRUE(w.wait([](const Snapshot& s) {
        return s.strategies && s.strategies->exponent == 0 && s.strategies->passes > 0;
    }));
    w.live.observe_strategies({});
    ASSERT_TRUE(w.wait([](const Snapshot& s) { return !s.strategies; }));
    w.live.set_limits(shown->passes + 200, {});
    const auto end = w.wait_finished(number);
    ASSERT_TRUE(end);
    expect_bits_of_batch(*end, j, end->passes);
}

TEST(LiveStrategies, AFinishedRenderAnswersAndRests) {
    Watched w;
    LiveJob j = job(build(room()), 24);
    j.stop_passes = 2;
    w.live.observe_strategies({.open = true, .selected = {{2, 1}}});
    const std::uint64_t number = w.live.submit(j);
    const auto first = w.wait_finished(number);
    ASSERT_TRUE(first && first->strategies);
    ASSERT_TRUE(first->strategies->selected_bare);
    w.live.observe_strategies({.open = true, .selected = {{1, 2}}, .kept = {{2, 1}}});
    const auto other = w.wait([](const Snapshot& s) {
        return s.strategies && s.strategies->selected == std::vector<Strategy>{{1, 2}};
    });
    ASSERT_TRUE(other);
    EXPECT_EQ(other->strategies->selected_bare, nullptr) << "it has no sample yet";
    w.live.observe_strategies({.open = true, .selected = {{2, 1}}, .kept = {{1, 2}}});
    const auto back =
        w.wait([](const Snapshot& s) { return s.strategies && s.strategies->selected_bare; });
    ASSERT_TRUE(back) << "what was chosen before was kept";
    EXPECT_EQ(back->strategies->selected_passes, 2u);
    EXPECT_TRUE(back->strategies->selected_bare->pixels ==
                first->strategies->selected_bare->pixels);
    EXPECT_EQ(back->job, number);
    expect_bits_of_batch(*back, j, 2);
    const std::clock_t clock = std::clock();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_LT(double(std::clock() - clock) / CLOCKS_PER_SEC, 0.02);
}

}  // namespace
}  // namespace midway::test
