// A LiveRender, somebody who watches it, a small room for it to render, and what its images must
// be.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "render/live_render.h"
#include "support/scenes.h"

namespace midway::test {

inline SceneDescription room(const vec3& paint = vec3(0.6f)) {
    SceneDescription s;
    add(s, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(paint));
    add(s, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    add(s, make_icosphere({0.5f, 0.5f, 0}, 0.5f, 2, false, true), glass(0));
    add(s, make_icosphere({-0.6f, 0.4f, 0}, 0.4f, 2, false, true), metal(0.3f));
    s.lights = {point_light({1, 1.5f, 1}, 1)};
    s.sky = constant_sky(vec3(0.2f));
    return s;
}

inline CameraDescription eye(double turn = 0) {
    return camera_at({4 * std::sin(turn), 1, 4 * std::cos(turn)}, {0, 0.5f, 0}, 0.8);
}

inline LiveJob job(const std::shared_ptr<const Scene>& scene, int size, int threads = 2) {
    LiveJob j;
    j.scene = scene;
    j.camera = eye();
    j.settings = settings(Technique::bdpt, size, 5);
    j.threads = threads;
    return j;
}

// A LiveRender and somebody who sleeps until it shows what is waited for.
class Watched {
  public:
    LiveRender live{[this] {
        const std::lock_guard lock(mutex_);
        ++news_;
        changed_.notify_all();
    }};

    // The newest snapshot, once it fulfils the condition; null after a minute.
    template <class Condition>
    std::shared_ptr<const Snapshot> wait(const Condition& fulfilled) {
        std::unique_lock lock(mutex_);
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        for (;;) {
            const int seen = news_;
            lock.unlock();
            const std::shared_ptr<const Snapshot> s = live.snapshot();
            if (s && fulfilled(*s)) return s;
            lock.lock();
            if (!changed_.wait_until(lock, deadline, [&] { return news_ != seen; })) return {};
        }
    }

    std::shared_ptr<const Snapshot> wait_finished(std::uint64_t number) {
        return wait([&](const Snapshot& s) { return s.job == number && s.finished; });
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int news_ = 0;
};

inline void expect_bits_of_batch(const Snapshot& s, const LiveJob& j, std::uint64_t passes) {
    EXPECT_EQ(s.error, "");
    EXPECT_EQ(s.scale, 1);
    EXPECT_EQ(s.passes, passes);
    RendererOptions options;
    options.threads = 1;
    ProgressiveRenderer batch(j.scene, j.camera, j.settings, options);
    batch.render_passes(passes);
    ASSERT_EQ(s.images.size(), j.settings.exponents.size());
    for (size_t i = 0; i < s.images.size(); ++i) {
        const int k = static_cast<int>(i);
        EXPECT_TRUE(s.images[i]->pixels == batch.image(k).pixels) << i;
        ASSERT_EQ(s.variances[i] != nullptr, passes > 1);
        if (passes > 1) {
            EXPECT_TRUE(s.variances[i]->pixels == batch.variance(k).pixels) << i;
        }
    }
    EXPECT_EQ(s.statistics.rays.closest, batch.statistics().rays.closest);
    EXPECT_EQ(s.statistics.rays.shadow, batch.statistics().rays.shadow);
}

}  // namespace midway::test
