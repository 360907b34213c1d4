// What works beside the window: changes of the scene and files to write. tests/run runs these cases
// under the thread sanitizer too.
#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <thread>

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

}  // namespace
}  // namespace midway::test
