// Rendering for a window: nobody waits, nothing is lost, and at rest the image is that of the
// batch. tests/run runs these cases under the thread sanitizer too.
#include <gtest/gtest.h>

#include <ctime>
#include <random>
#include <set>
#include <thread>

#include "support/tier.h"
#include "support/watched_render.h"

namespace midway::test {
namespace {

using Clock = std::chrono::steady_clock;

TEST(LiveRender, HasTheBitsOfTheBatch) {
    const auto scene = build(room());
    Watched w;
    for (const Technique technique : {Technique::path, Technique::light, Technique::bdpt})
        for (const std::uint64_t passes : {1, 2, 7}) {
            LiveJob j = job(scene, 40);
            j.settings.technique = technique;
            j.settings.exponents = {2, 0, 1, 3.5};
            if (passes == 2) j.settings.crop = PixelRect{3, 5, 30, 21};
            j.stop_passes = passes;
            const auto s = w.wait_finished(w.live.submit(j));
            ASSERT_TRUE(s);
            expect_bits_of_batch(*s, j, passes);
        }
}

TEST(LiveRender, ShowsCoarseImagesFirst) {
    const auto scene = build(room());
    Watched w;
    LiveJob j = job(scene, 301);
    j.settings.height = 210;
    j.stop_passes = 1;
    const std::uint64_t number = w.live.submit(j);
    std::vector<int> scales;
    ASSERT_TRUE(w.wait([&](const Snapshot& s) {
        if (scales.empty() || s.scale != scales.back()) scales.push_back(s.scale);
        EXPECT_EQ(s.images[0]->width, (301 + s.scale - 1) / s.scale);
        EXPECT_EQ(s.images[0]->height, (210 + s.scale - 1) / s.scale);
        return s.job == number && s.finished;
    }));
    EXPECT_GT(scales.front(), 4);
    EXPECT_EQ(scales.back(), 1);
    EXPECT_TRUE(std::is_sorted(scales.rbegin(), scales.rend()));
    EXPECT_EQ(w.live.latency().job, number);
    EXPECT_GT(w.live.latency().first_image_seconds, 0);
}

// What is seen at a place of the whole image is seen there at every scale, whatever the remainder.
TEST(LiveRender, CoarsePixelsLieWhereTheirsAre) {
    LiveJob j;
    j.camera = eye(0.3);
    j.settings.width = 301;
    j.settings.height = 210;
    const Normalisation normalisation;
    const Camera whole = make_camera(j.camera, normalisation, 301, 210);
    for (const std::optional<PixelRect> crop :
         {std::optional<PixelRect>(), std::optional(PixelRect{17, 20, 171, 90})})
        for (const int scale : {1, 2, 3, 7, 16, 31}) {
            j.settings.crop = crop;
            const ScaledView v = scaled_view(j, scale);
            const int width = v.settings.width, height = v.settings.height;
            const Camera coarse = make_camera(v.camera, normalisation, width, height);
            const PixelRect c = v.settings.crop.value_or(PixelRect{0, 0, width, height});
            for (const vec2 corner : {vec2(c.x0, c.y0), vec2(c.x1, c.y1), vec2(c.x0 + 1, c.y0)}) {
                const vec3 d = camera_direction(coarse, coarse.position, corner);
                const auto seen = film_position(whole, whole.position, d);
                ASSERT_TRUE(seen);
                EXPECT_NEAR(seen->x, v.placement.x0 + (corner.x - c.x0) * scale, 2e-3);
                EXPECT_NEAR(seen->y, v.placement.y0 + (corner.y - c.y0) * scale, 2e-3);
            }
            const PixelRect all = crop.value_or(PixelRect{0, 0, 301, 210});
            EXPECT_LE(v.placement.x0, all.x0);
            EXPECT_GE(v.placement.x1, all.x1);
            EXPECT_GT(v.placement.x0, all.x0 - scale);
            EXPECT_LT(v.placement.y1, all.y1 + scale);
        }
}

TEST(LiveRender, GoesOnWhereLimitsAreRaised) {
    Watched w;
    LiveJob j = job(build(room()), 24);
    j.stop_passes = 3;
    const std::uint64_t number = w.live.submit(j);
    ASSERT_TRUE(w.wait_finished(number));
    w.live.set_limits(11, {});
    const auto s = w.wait([](const Snapshot& k) { return k.finished && k.passes > 3; });
    ASSERT_TRUE(s);
    expect_bits_of_batch(*s, j, 11);
}

TEST(LiveRender, StopsAtATime) {
    Watched w;
    LiveJob j = job(build(room()), 24);
    j.stop_seconds = 0.2;
    const auto s = w.wait_finished(w.live.submit(j));
    ASSERT_TRUE(s);
    EXPECT_GE(s->seconds, 0.2);
    expect_bits_of_batch(*s, j, s->passes);
}

double process_seconds_during(std::chrono::milliseconds time) {
    const std::clock_t before = std::clock();
    std::this_thread::sleep_for(time);
    return double(std::clock() - before) / CLOCKS_PER_SEC;
}

TEST(LiveRender, SleepsInTheMiddleOfAPass) {
    Watched w;
    // From its first coarse image on, the job works for most of a second before it comes to a rest.
    w.live.submit(job(build(room()), 1000, 1));
    ASSERT_TRUE(w.wait([](const Snapshot&) { return true; }));
    w.live.pause(true);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LT(process_seconds_during(std::chrono::milliseconds(200)), 0.02);
}

TEST(LiveRender, SleepsWhilePausedAndLosesNothing) {
    Watched w;
    LiveJob j = job(build(room()), 64);
    const auto began = Clock::now();
    const std::uint64_t number = w.live.submit(j);
    for (const std::uint64_t passes : {1, 3, 6}) {
        const auto before = w.wait([&](const Snapshot& s) {
            return s.job == number && s.scale == 1 && s.passes >= passes;
        });
        ASSERT_TRUE(before);
        w.live.pause(true);
        EXPECT_TRUE(w.live.snapshot()->paused);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_LT(process_seconds_during(std::chrono::milliseconds(200)), 0.02);
        w.live.pause(false);
        EXPECT_FALSE(w.live.snapshot()->paused);
    }
    w.live.set_limits(40, {});
    const auto s = w.wait_finished(number);
    ASSERT_TRUE(s);
    expect_bits_of_batch(*s, j, s->passes);
    // Three pauses of a quarter of a second are no rendering.
    EXPECT_LT(s->seconds, std::chrono::duration<double>(Clock::now() - began).count() - 0.7);
    // A finished job costs nothing either.
    EXPECT_LT(process_seconds_during(std::chrono::milliseconds(200)), 0.02);
}

TEST(LiveRender, ShowsOnePassOfAJobThatComesWhilePaused) {
    Watched w;
    LiveJob j = job(build(room()), 64);
    w.live.pause(true);
    const std::uint64_t number = w.live.submit(j);
    const auto s = w.wait([&](const Snapshot& k) { return k.job == number && k.scale == 1; });
    ASSERT_TRUE(s);
    EXPECT_TRUE(s->paused);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    expect_bits_of_batch(*w.live.snapshot(), j, 1);
    w.live.pause(false);
    EXPECT_TRUE(w.wait([](const Snapshot& k) { return k.passes > 1; }));
}

TEST(LiveRender, SaysWhatIsWrongWithAJob) {
    const auto scene = build(room());
    Watched w;
    LiveJob j = job(scene, 24);
    j.settings.crop = PixelRect{0, 0, 25, 24};
    const auto s = w.wait_finished(w.live.submit(j));
    ASSERT_TRUE(s);
    EXPECT_NE(s->error, "");
    EXPECT_TRUE(s->images.empty());
    j.settings.crop.reset();
    j.stop_passes = 2;
    const auto next = w.wait_finished(w.live.submit(j));
    ASSERT_TRUE(next);
    expect_bits_of_batch(*next, j, 2);
}

// Edits that come faster than images are finished still let images through.
TEST(LiveRender, AStreamOfEditsDoesNotStarve) {
    Watched w;
    LiveJob j = job(build(room()), 1600);
    std::set<std::uint64_t> shown;
    const auto deadline = Clock::now() + std::chrono::seconds(20);
    for (int i = 0; shown.size() < 8 && Clock::now() < deadline; ++i) {
        j.camera = eye(0.01 * i);
        w.live.submit(j);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        // By then it is known what an image of 20 ms is.
        const auto s = w.live.snapshot();
        if (i > 100 && s) shown.insert(s->job);
    }
    EXPECT_GE(shown.size(), 8u);
}

TEST(LiveRender, ShowsChannelsOnDemand) {
    Watched w;
    LiveJob j = job(build(room()), 50);
    j.stop_passes = 1;
    ASSERT_TRUE(w.wait_finished(w.live.submit(j)));
    EXPECT_FALSE(w.live.channels());
    w.live.request_channels(true);
    w.wait([&](const Snapshot&) { return w.live.channels() && w.live.channels()->samples == 16; });
    const auto c = w.live.channels();
    ASSERT_TRUE(c);
    const Estimator e = make_estimator(*j.scene, j.camera, j.settings);
    const AovImages direct = render_aovs(e, 16, 1);
    EXPECT_EQ(c->scale, 1);
    EXPECT_TRUE(c->images.albedo.pixels == direct.albedo.pixels);
    EXPECT_TRUE(c->images.normal.pixels == direct.normal.pixels);
    EXPECT_TRUE(c->images.depth.pixels == direct.depth.pixels);
    EXPECT_TRUE(c->images.object.pixels == direct.object.pixels);
    w.live.clear();
    EXPECT_FALSE(w.live.channels());
    EXPECT_FALSE(w.live.snapshot());
}

// What a person can do to a window in any order, hundreds of times; then the image is right.
TEST(LiveRender, SurvivesAThousandEdits) {
    const std::vector<std::shared_ptr<const Scene>> scenes = {build(room()),
                                                              build(room(vec3(0.2f, 0.5f, 0.8f)))};
    Watched w;
    std::mt19937 random(7);
    const auto below = [&](unsigned n) { return random() % n; };
    const int edits = by_tier(200, 1000);
    for (int i = 0; i < edits; ++i) {
        switch (below(12)) {
            case 0:
                w.live.pause(below(2) == 0);
                break;
            case 1:
                w.live.request_channels(below(2) == 0);
                break;
            case 2:
                w.live.clear();
                break;
            case 3:
                w.live.set_limits(below(5) + 1, {});
                break;
            default:
                LiveJob j = job(scenes[below(2)], 20 + static_cast<int>(below(60)),
                                1 + static_cast<int>(below(3)));
                j.camera = eye(0.1 * below(10));
                j.settings.exponents.resize(1 + below(4), 1.0);
                j.settings.technique = static_cast<Technique>(below(3));
                j.settings.seed = below(3);
                if (below(4) == 0) j.stop_passes = 1 + below(3);
                j.statistics = below(4) == 0;
                w.live.submit(std::move(j));
        }
        if (const auto s = w.live.snapshot()) {
            EXPECT_EQ(s->error, "");
            // Whole passes, and nothing of another job.
            EXPECT_EQ(s->statistics.rays.camera_paths, s->passes * s->images[0]->pixels.size());
            EXPECT_EQ(s->images.size(), s->exponents.size());
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(below(3) * below(8)));
    }
    w.live.pause(false);
    LiveJob j = job(scenes[1], 40);
    j.stop_passes = 4;
    const auto s = w.wait_finished(w.live.submit(j));
    ASSERT_TRUE(s);
    expect_bits_of_batch(*s, j, 4);
}

TEST(LiveRender, StartsAndEndsAtAnyTime) {
    const auto scene = build(room());
    for (int i = 0; i < by_tier(40, 200); ++i) {
        LiveRender live;
        if (i % 4 > 0) live.submit(job(scene, 100));
        if (i % 4 > 1) std::this_thread::sleep_for(std::chrono::milliseconds(i % 9));
        if (i % 4 > 2) live.pause(true);
        live.request_channels(i % 2 == 0);
    }
}

}  // namespace
}  // namespace midway::test
