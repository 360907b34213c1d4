#include "report/brightest.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <tuple>

#include "math/float_mode.h"
#include "render/worker_priority.h"

namespace midway {
namespace {

// What a sample gives to the pixel that is watched.
struct Watch {
    const Recording& recording;
    int x = 0, y = 0;
    size_t exponent = 0, exponents = 1;
    bool own = false;  // the sample is one of that pixel's
    vec3 sum{0};

    bool wants(const Strategy& k) const { return recording.wants(k); }
    void contribution(const Contribution& c) {
        if (own) add(c);
    }
    void splat(int to_x, int to_y, const Contribution& c) {
        if (to_x == x && to_y == y) add(c);
    }
    void add(const Contribution& c) {
        if (is_usable(c, exponents)) sum += recorded_value(recording, c, exponent).value;
    }
};

auto place_of(const BrightSample& s) { return std::tie(s.pass, s.y, s.x); }

void keep_brighter(std::optional<BrightSample>& best, const BrightSample& s) {
    if (!(s.luminance > 0)) return;
    if (!best || s.luminance > best->luminance ||
        (s.luminance == best->luminance && place_of(s) < place_of(*best)))
        best = s;
}

class Replayer {
  public:
    Replayer(const BrightestSearch& search, const Estimator& e, const Recording& recording)
        : search_(search),
          e_(e),
          watch_{recording, search.x, search.y, search.exponent,
                 static_cast<size_t>(e.exponent_count)} {}

    void replay(int x, int y, std::uint64_t pass) {
        watch_.own = x == search_.x && y == search_.y;
        watch_.sum = vec3(0);
        if (watch_.own)
            estimate_alone(e_, x, y, pass, light_, watch_, rays_);
        else
            for_each_subpath(e_, paired_subpath(e_, x, y, pass), [&](std::uint64_t subpath) {
                trace_light_subpath(e_, subpath, pass, light_.spare, watch_, rays_);
            });
        keep_brighter(best, {x, y, pass, watch_.sum, luminance(watch_.sum)});
    }

    std::optional<BrightSample> best;

  private:
    const BrightestSearch& search_;
    const Estimator& e_;
    Watch watch_;
    LightSubpaths light_;
    RayCounts rays_;
};

Estimator estimator_of(const BrightestSearch& s) {
    return make_estimator(*s.what.scene, s.what.camera, s.what.settings);
}

}  // namespace

std::optional<BrightSample> brightest_own_sample(const BrightestSearch& s,
                                                 const RenderControl& control) {
    const ScopedFlushToZero flush;
    const Estimator e = estimator_of(s);
    const Recording recording = make_recording(s.what.settings);
    Replayer replayer(s, e, recording);
    for (std::uint64_t i = 0; i < s.passes; ++i) {
        if (!control.go_on()) return {};
        replayer.replay(s.x, s.y, s.first_pass + i);
    }
    return replayer.best;
}

std::optional<BrightSample> brightest_sample(const BrightestSearch& s, const RenderControl& control,
                                             const SearchTick& tick) {
    const Estimator e = estimator_of(s);
    const Recording recording = make_recording(s.what.settings);
    // Samples of other pixels reach this one by splats alone.
    if (!e.families.light_tracing) return brightest_own_sample(s, control);
    const std::uint64_t rows = static_cast<std::uint64_t>(e.crop.height());
    const std::uint64_t items = s.passes * rows;
    const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    int running = s.threads > 0 ? s.threads : processors;
    std::atomic<std::uint64_t> next{0};
    std::optional<BrightSample> best;
    std::mutex mutex;
    std::condition_variable finished;
    const auto work = [&] {
        const ScopedFlushToZero flush;
        lower_priority();
        Replayer replayer(s, e, recording);
        for (std::uint64_t i = next++; i < items && control.go_on(); i = next++) {
            const int y = e.crop.y0 + static_cast<int>(i % rows);
            for (int x = e.crop.x0; x < e.crop.x1 && !control.cancelled(); ++x)
                replayer.replay(x, y, s.first_pass + i / rows);
            const std::lock_guard lock(mutex);
            if (replayer.best) keep_brighter(best, *replayer.best);
        }
        const std::lock_guard lock(mutex);
        --running;
        finished.notify_one();
    };
    std::vector<std::jthread> workers;
    for (int i = 0, count = running; i < count; ++i) workers.emplace_back(work);
    std::unique_lock lock(mutex);
    while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return running == 0; })) {
        const std::optional<BrightSample> so_far = best;
        lock.unlock();
        if (tick) tick(std::min(1.0, double(next) / double(items)), so_far);
        lock.lock();
    }
    if (control.cancelled()) return {};
    return best;
}

std::optional<ivec2> brightest_outlier(const Image& image, const Image& variance) {
    std::optional<ivec2> at;
    float most = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float deviation = std::sqrt(luminance(variance.at(x, y)));
            if (!(deviation > most)) continue;
            std::array<float, 8> around{};
            size_t count = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int nx = x + dx, ny = y + dy;
                    if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= image.width ||
                        ny >= image.height)
                        continue;
                    around[count++] = luminance(image.at(nx, ny));
                }
            float median = 0;
            if (count > 0) {
                const auto middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
                std::nth_element(around.begin(), middle,
                                 around.begin() + static_cast<std::ptrdiff_t>(count));
                median = *middle;
            }
            const float stands_out = std::min(deviation, luminance(image.at(x, y)) - median);
            if (!(stands_out > most)) continue;
            most = stands_out;
            at = ivec2(x, y);
        }
    return at;
}

}  // namespace midway
