// How fast a scene renders on this machine, and how far that is from what its rays alone would
// take. The rays of whole passes are recorded, one pass a thread, and traced once more without
// anything around them: limit_ratio is the time of these replays over that of rendering as many
// passes. It is a diagnostic, not a goal: fewer rays that lower the error as much make it worse.
//
// Rounds take turns (render, replay, render apart), so that a machine whose speed drifts treats
// all alike; figures are medians with the interval that holds the median of 95 % of such series.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "render/renderer.h"

namespace midway {

struct BenchOptions {
    int threads = 0;  // 0: all processors
    int rounds = 9;
    double seconds = 0.3;         // of rendering, in each round, at least
    double watch_seconds = 2;     // for the shares
    size_t log_bytes = 1u << 30;  // of recorded rays, all threads together
};

// Median of a series with an interval from its order statistics.
struct Middle {
    double median = 0, low = 0, high = 0;
};
Middle middle_of(std::vector<double> values);

struct BenchResult {
    int threads = 0;
    std::uint64_t passes = 0;  // that one round renders
    Middle seconds_per_pass;   // rendering, all threads
    Middle limit_ratio;
    // Time of one renderer with all threads over that of as many renderers with a thread each, each
    // with a film of its own: what sharing costs.
    Middle sharing;
    RayCounts per_pass;         // means
    double samples_per_second;  // camera samples
    double rays_per_second = 0, replayed_per_second = 0;
    bool whole_log = true;  // false: only the first rays of a pass fitted into memory
    std::array<double, work_kinds> shares{};  // of the workers' time, by Work
    struct Scaling {
        int threads = 0;
        double samples_per_second = 0;
    };
    std::vector<Scaling> scaling;  // 1, 2, 4, ... threads
};

// Throws as make_estimator(). `progress` is told what is done and the share.
BenchResult run_bench(const std::shared_ptr<const Scene>& scene, const CameraDescription& camera,
                      const RenderSettings& settings, const BenchOptions& options,
                      const std::function<void(const char*, double)>& progress = {});

}  // namespace midway
