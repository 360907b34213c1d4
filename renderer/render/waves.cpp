#include "render/waves.h"

#include <algorithm>
#include <chrono>

namespace midway {
namespace {

// Long enough that the threads' idle end of a wave is small, short enough to stop soon.
constexpr double longest_wave_seconds = 1.0;

}  // namespace

double render_in_waves(ProgressiveRenderer& r, const WaveLimits& limits,
                       const std::function<bool()>& stop,
                       const std::function<void(const WaveState&)>& progress) {
    using Clock = std::chrono::steady_clock;
    auto start = Clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(Clock::now() - start).count();
    };
    const std::uint64_t first = r.passes();
    std::uint64_t wave = 1;
    const auto state = [&](double in_wave) {
        const double passes = double(r.passes() - first) + in_wave;
        double done = 0;
        if (limits.passes) done = passes / std::max(1.0, double(*limits.passes));
        if (limits.seconds) done = std::max(done, seconds() / *limits.seconds);
        return WaveState{std::min(done, 1.0), passes, in_wave == 0};
    };
    while (!limits.passes || r.passes() - first < *limits.passes) {
        const double elapsed = seconds();
        const std::uint64_t finished = r.passes() - first;
        if (finished > 0) {
            if (stop() || (limits.seconds && elapsed >= *limits.seconds)) break;
            const double per_pass = elapsed / double(finished);
            double room = longest_wave_seconds;
            if (limits.seconds) room = std::min(room, *limits.seconds - elapsed);
            const double fits = std::max(1.0, room / std::max(per_pass, 1e-9));
            wave =
                std::min<std::uint64_t>(finished, static_cast<std::uint64_t>(std::min(fits, 1e9)));
        }
        if (limits.passes) wave = std::min(wave, *limits.passes - finished);
        const double in_wave = double(wave);
        r.render_passes(wave, [&](double share) { progress(state(share * in_wave)); });
        // What is done between waves, as writing a checkpoint, is no rendering.
        const auto between = Clock::now();
        progress(state(0));
        start += Clock::now() - between;
    }
    return seconds();
}

}  // namespace midway
