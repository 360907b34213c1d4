// Rows of whole passes shared out to threads, as the audit draws them. Sums are kept per worker and
// must not depend on who took which row.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "integrator/walk.h"
#include "math/float_mode.h"

namespace midway {

struct AuditPasses {
    std::uint64_t first = 0, end = 0;
};

inline int worker_count(int threads) {
    return threads > 0 ? threads
                       : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Calls sample(sums[worker], x, y, pass) for every pixel of the crop and every pass; `tick` about
// ten times a second with the share done.
template <class Sums, class Sample>
void for_each_sample(const PixelRect& crop, const AuditPasses& passes, std::vector<Sums>& sums,
                     const Sample& sample, const std::function<void(double)>& tick = {}) {
    const auto rows = static_cast<std::uint64_t>(crop.height());
    const std::uint64_t items = (passes.end - passes.first) * rows;
    std::atomic<std::uint64_t> next{0};
    std::mutex mutex;
    std::condition_variable finished;
    size_t running = sums.size();
    std::vector<std::jthread> workers;
    for (Sums& s : sums)
        workers.emplace_back([&] {
            const ScopedFlushToZero flush;
            for (std::uint64_t i = next++; i < items; i = next++)
                for (int x = crop.x0; x < crop.x1; ++x)
                    sample(s, x, crop.y0 + static_cast<int>(i % rows), passes.first + i / rows);
            const std::lock_guard lock(mutex);
            --running;
            finished.notify_one();
        });
    std::unique_lock lock(mutex);
    while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return running == 0; }))
        if (tick && items > 0) tick(std::min(1.0, double(next) / double(items)));
}

// The passes still to be drawn where the first gave `found` of the `wanted` things; a scene that
// gives next to none is not drawn for ever.
inline std::uint64_t passes_for(std::int64_t wanted, std::uint64_t found) {
    constexpr std::uint64_t most = 10000;
    if (wanted <= 0) return 1;
    const std::uint64_t per_pass = std::max<std::uint64_t>(1, found);
    return std::min(most, (static_cast<std::uint64_t>(wanted) + per_pass - 1) / per_pass);
}

}  // namespace midway
