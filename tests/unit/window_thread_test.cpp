// What works beside the window: changes of the scene and files to write. tests/run runs these cases
// under the thread sanitizer too.
#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <thread>

#include "render/live_render.h"
#include "report/error_log.h"
#include "viewer/error_meter.h"
#include "viewer/tasks.h"
#include "viewer/update.h"

namespace midway::test {
namespace {

std::shared_ptr<const PreparedScene> assets_scene() {
    SceneOptions o;
    o.path = std::string(MIDWAY_SOURCE_DIR) + "/assets/cornell.glb";
    return std::make_shared<const PreparedScene>(prepare_scene(o));
}

template <class Take>
auto wait_for(const Take& take) {
    auto result = take();
    for (int i = 0; i < 12000 && !result; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        result = take();
    }
    return result;
}

TEST(SceneUpdater, MakesWhatUpdateSceneDoesAndReportsFaults) {
    const auto scene = assets_scene();
    std::atomic<int> calls = 0;
    SceneUpdater updater([&] { ++calls; });
    SceneOptions o = scene->options;
    o.lamp_strength = 3;
    updater.submit(scene, o);
    const auto result = wait_for([&] { return updater.take(); });
    ASSERT_TRUE(result && result->prepared);
    EXPECT_EQ(result->prepared->hash, update_scene(*scene, o).hash);
    EXPECT_EQ(calls, 1);
    EXPECT_FALSE(updater.busy());

    o.sky = "no such sky.hdr";
    updater.submit(scene, o);
    const auto broken = wait_for([&] { return updater.take(); });
    ASSERT_TRUE(broken);
    EXPECT_EQ(broken->prepared, nullptr);
    EXPECT_NE(broken->error.find("no such sky.hdr"), std::string::npos);
}

TEST(SceneUpdater, TheNewestChangeComesLast) {
    const auto scene = assets_scene();
    SceneUpdater updater([] {});
    SceneOptions o = scene->options;
    for (int i = 1; i <= 50; ++i) {
        o.lamp_strength = static_cast<float>(i);
        updater.submit(scene, o);
    }
    float last = 0;
    for (int i = 0; i < 12000 && last < 50; ++i) {
        if (const auto result = updater.take()) last = result->prepared->options.lamp_strength;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_EQ(last, 50);
}

TEST(SceneUpdater, NothingComesOfWhatWasForgotten) {
    const auto scene = assets_scene();
    SceneUpdater updater([] {});
    for (int i = 0; i < 50; ++i) {
        updater.submit(scene, scene->options);
        updater.forget();
        EXPECT_FALSE(updater.take());
    }
    while (updater.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_FALSE(updater.take());
}

// Submits, forgets, takes and ends at any moment.
TEST(SceneUpdater, EndsAtAnyMoment) {
    const auto scene = assets_scene();
    std::mt19937 random(7);
    for (int i = 0; i < 1000; ++i) {
        Waker waker;
        std::atomic<int> woken = 0;
        SceneUpdater updater([&] { waker.wake(); });
        waker.set([&] { ++woken; });
        SceneOptions o = scene->options;
        for (int k = 0; k < 3; ++k) {
            o.lamp_strength = static_cast<float>(random() % 5);
            updater.submit(scene, o);
            if (random() % 3 == 0) updater.forget();
            std::this_thread::sleep_for(std::chrono::microseconds(random() % 400));
            updater.take();
        }
        waker.set({});
    }
}

// The same file read again is another one, though its name is the same.
TEST(SceneUpdater, StartsFromTheFileThatItIsGiven) {
    const auto first = assets_scene(), second = assets_scene();
    SceneUpdater updater([] {});
    SceneOptions o = first->options;
    for (const auto& scene : {first, second, first}) {
        o.lamp_strength += 1;
        updater.submit(scene, o);
        const auto result = wait_for([&] { return updater.take(); });
        ASSERT_TRUE(result && result->prepared);
        EXPECT_EQ(result->prepared->file, scene->file);
    }
}

// What an edited scene shares with the ones before is read by their workers and by the updater at
// once; the last image is that of the edits loaded with the file.
TEST(SceneUpdater, EditsStreamIntoTheRender) {
    const auto scene = assets_scene();
    SceneUpdater updater([] {});
    LiveRender live;
    std::mt19937 random(11);
    LiveJob job;
    job.settings.width = job.settings.height = 24;
    job.settings.max_bounces = 4;
    job.threads = 2;
    SceneOptions o = scene->options;
    std::shared_ptr<const PreparedScene> now = scene;
    const auto show = [&](const std::optional<UpdateResult>& result) {
        if (!result) return;
        ASSERT_TRUE(result->prepared) << result->error;
        now = result->prepared;
        job.scene = now->scene;
        job.camera = now->camera;
        live.submit(job);
    };
    const auto materials = static_cast<int>(scene->file->materials.size());
    for (int i = 0; i < 200; ++i) {
        const int k = static_cast<int>(random()) % materials;
        MaterialEdit e = edit_of(o.edits, scene->file->materials, std::abs(k));
        if (random() % 2) e.emission_strength = float(random() % 3);
        if (random() % 2) e.transmission = float(random() % 2);
        if (random() % 8 == 0) e.alpha = 0.5f;
        set_edit(o.edits, scene->file->materials, std::abs(k), e);
        if (random() % 8 == 0) o.sky = random() % 2 ? "0.1,0.2,0.3" : "1,1,1";
        updater.submit(now, o);
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
        show(updater.take());
    }
    while (updater.busy()) {
        show(updater.take());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const PreparedScene fresh = prepare_scene(o);
    EXPECT_EQ(now->hash, fresh.hash);
    job.stop_passes = 2;
    const std::uint64_t last = live.submit(job);
    const auto done = wait_for([&] {
        const auto s = live.snapshot();
        return s && s->job == last && s->finished ? s : nullptr;
    });
    ASSERT_TRUE(done);
    ProgressiveRenderer r(fresh.scene, fresh.camera, job.settings, {});
    r.render_passes(2);
    EXPECT_TRUE(done->images[0]->pixels == r.image().pixels);
}

TEST(Tasks, RunInOrderAndFinishBeforeTheEnd) {
    std::string order;
    {
        Tasks tasks([] {});
        for (char c = 'a'; c <= 'e'; ++c)
            tasks.submit([&order, c] {
                order += c;
                if (c == 'c') throw std::runtime_error("disk full (c); make room");
                return std::string(1, c);
            });
        for (char c = 'a'; c <= 'd'; ++c) {
            const auto result = wait_for([&] { return tasks.take(); });
            ASSERT_TRUE(result);
            EXPECT_EQ(result->notice, c == 'c' ? "" : std::string(1, c));
            EXPECT_EQ(result->error, c == 'c' ? "disk full (c); make room" : "");
        }
    }
    EXPECT_EQ(order, "abcde");
}

// A snapshot of a whole image of 16 x 12, or of a part of it, two exponents from the same paths.
std::shared_ptr<const Snapshot> made_up_snapshot(std::uint64_t passes, const PixelRect& crop) {
    auto s = std::make_shared<Snapshot>();
    s->job = 3;
    s->width = 16;
    s->height = 12;
    s->crop = crop;
    s->exponents = {0, 2};
    s->passes = passes;
    s->seconds = 0.5 * double(passes);
    std::mt19937 random(static_cast<unsigned>(passes));
    std::uniform_real_distribution<float> value(0.5f, 1);
    for (int i = 0; i < 2; ++i) {
        auto image = std::make_shared<Image>(crop.width(), crop.height());
        auto variance = std::make_shared<Image>(crop.width(), crop.height());
        for (size_t k = 0; k < image->pixels.size(); ++k) {
            image->pixels[k] = vec3(value(random));
            variance->pixels[k] = vec3(0.01f * value(random));
        }
        s->images.push_back(image);
        s->variances.push_back(variance);
    }
    return s;
}

std::shared_ptr<const Reference> made_up_reference(int width, int height) {
    auto r = std::make_shared<Reference>();
    r->image = Image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) r->image.at(x, y) = vec3(0.5f + 0.02f * float(x + y));
    return r;
}

TEST(ErrorMeter, MeasuresWhatTheErrorLogDoes) {
    std::atomic<int> calls = 0;
    ErrorMeter meter([&] { ++calls; });
    const auto snapshot = made_up_snapshot(8, {0, 0, 16, 12});
    const auto reference = made_up_reference(16, 12);
    meter.submit({snapshot, reference});
    EXPECT_TRUE(meter.busy());
    const auto m = wait_for([&] { return meter.take(); });
    ASSERT_TRUE(m);
    EXPECT_FALSE(meter.busy());
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(m->job, 3u);
    EXPECT_EQ(m->passes, 8u);
    ASSERT_EQ(m->points.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        const ErrorPoint p = measure_error(*reference, *snapshot->images[i], 8, {4, 0});
        EXPECT_EQ(m->points[i].measured->relmse, p.relmse);
        EXPECT_EQ(m->points[i].measured->relmse_trimmed, p.relmse_trimmed);
        EXPECT_EQ(m->points[i].measured->bias, p.bias);
        EXPECT_EQ(m->points[i].estimate,
                  estimate_relmse(*snapshot->images[i], *snapshot->variances[i], {4, 4}).value());
        EXPECT_EQ(m->points[i].seconds, 4);
    }
}

TEST(ErrorMeter, OfARegionTakesThatPartOfTheReference) {
    const PixelRect crop{3, 2, 11, 9};
    const auto whole = made_up_reference(16, 12);
    auto part = std::make_shared<Reference>();
    part->image = Image(8, 7);
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 8; ++x) part->image.at(x, y) = whole->image.at(3 + x, 2 + y);
    const auto snapshot = made_up_snapshot(4, crop);
    EXPECT_EQ(measure({snapshot, whole})[0].measured->relmse,
              measure({snapshot, part})[0].measured->relmse);
    EXPECT_THROW(measure({snapshot, made_up_reference(12, 16)}), std::runtime_error);
    ErrorMeter meter([] {});
    meter.submit({snapshot, made_up_reference(12, 16)});
    const auto m = wait_for([&] { return meter.take(); });
    ASSERT_TRUE(m);
    EXPECT_TRUE(m->points.empty());
    EXPECT_NE(m->error.find("12x16"), std::string::npos);
}

TEST(ErrorMeter, TheNewestComesLastAndNoneIsMixed) {
    ErrorMeter meter([] {});
    std::uint64_t last = 0;
    const auto take = [&] {
        while (const auto m = meter.take()) {
            EXPECT_GT(m->passes, last);
            last = m->passes;
            EXPECT_EQ(m->points[0].spp, last);
        }
    };
    for (std::uint64_t n = 2; n <= 300; ++n) {
        meter.submit({made_up_snapshot(n, {0, 0, 16, 12}), nullptr});
        take();
    }
    wait_for([&]() -> std::optional<int> {
        take();
        return last == 300 ? std::optional<int>(1) : std::nullopt;
    });
    EXPECT_EQ(last, 300u);
}

}  // namespace
}  // namespace midway::test
