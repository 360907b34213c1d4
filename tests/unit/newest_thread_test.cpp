// The worker that does the newest request alone. tests/run runs these cases under the thread
// sanitizer too.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "report/brightest.h"
#include "support/scenes.h"
#include "viewer/newest.h"

namespace midway::test {
namespace {

template <class Worker>
auto wait_for_result(Worker& worker) {
    auto result = worker.take();
    for (int i = 0; i < 12000 && !result; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        result = worker.take();
    }
    return result;
}

TEST(NewestWorker, AnswersTheNewestAndForgetsTheRest) {
    std::atomic<int> woken = 0;
    NewestWorker<int, int> worker(
        [](const int& n, const RenderControl& control, const auto& publish) {
            publish(-n);
            // The first request never ends by itself.
            while (n == 1 && control.go_on()) std::this_thread::yield();
            publish(10 * n);
        },
        [&] { ++woken; });
    worker.submit(1);
    while (worker.take() != -1) std::this_thread::yield();
    for (int n = 2; n < 50; ++n) worker.submit(n);
    int last = 0;
    while (last != 490) {
        const auto result = wait_for_result(worker);
        ASSERT_TRUE(result);
        EXPECT_NE(*result, 10) << "the first was forgotten";
        last = *result;
    }
    while (worker.busy()) std::this_thread::yield();
    EXPECT_GT(woken, 0);
}

TEST(NewestWorker, NothingComesOfWhatWasCancelledAndTheEndWaitsForNoSearch) {
    std::atomic<bool> began = false, ended = false;
    NewestWorker<int, int> worker(
        [&](const int&, const RenderControl& control, const auto& publish) {
            began = true;
            while (control.go_on()) std::this_thread::yield();
            publish(1);
            ended = true;
        },
        [] {});
    worker.submit(1);
    while (!began) std::this_thread::yield();
    worker.cancel();
    while (!ended) std::this_thread::yield();
    EXPECT_FALSE(worker.take());
    worker.submit(2);
}

// A search on several threads that is watched and stopped while it runs.
TEST(NewestWorker, RunsASearchThatCanBeStopped) {
    SceneDescription s;
    add(s, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(vec3(0.6f)));
    add(s, make_icosphere({0, 0.6f, 0}, 0.5f, 2, false, true), glass(0));
    add(s, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    BrightestSearch search;
    search.what = {build(s), camera_at({0, 1, 4}, {0, 0.5f, 0}, 0.8),
                   settings(Technique::bdpt, 16, 6)};
    search.x = search.y = 9;
    search.passes = std::uint64_t{1} << 40;
    search.threads = 3;
    std::atomic<int> ticks = 0;
    NewestWorker<BrightestSearch, float> worker(
        [&](const BrightestSearch& what, const RenderControl& control, const auto& publish) {
            brightest_sample(what, control, [&](double, const std::optional<BrightSample>& best) {
                ++ticks;
                if (best) publish(best->luminance);
            });
        },
        [] {});
    worker.submit(search);
    EXPECT_TRUE(wait_for_result(worker));
    worker.cancel();
    while (worker.busy()) std::this_thread::yield();
    EXPECT_GT(ticks, 0);
}

}  // namespace
}  // namespace midway::test
