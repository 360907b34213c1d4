// What each thing that a render leaves out saves, measured by doing it all the same. Two renderers
// take turns, one as it comes and one with a single thing turned on, over the very same samples;
// the processor time of each round gives a ratio, and the figure is the median of the ratios with
// the interval that holds it in 95 % of such series (report/bench.h).
//
// What is turned on finds nothing, so the image is the same to the bit, and that is checked. Where
// it is a matter of picking or of the plan of `auto`, other samples are taken; flat normal maps turn
// normals by their rounding, and where two triangles lie at one distance Embree may name the other
// once it asks for coverage: then the means are compared.
#pragma once

#include "render/prepare.h"
#include "report/bench.h"

namespace midway {

struct CostOptions {
    int threads = 0;  // 0: all processors
    int rounds = 9;
    double seconds = 0.15;  // of processor time, for each side of a round, at least
};

struct LeaveOutCost {
    std::string what, why;  // as in render/leave_outs.h
    Middle left_out, done;  // processor seconds per sample of a pixel
    Middle saving;          // share of the time with it done
    bool within_noise() const { return saving.low <= 0 && saving.high >= 0; }
    bool same_bits = false;
    // The mean of the image with it done over that without, and bounds that the truth leaves once
    // in a thousand rows; one where the bits are the same.
    double mean_ratio = 1, mean_low = 1, mean_high = 1;
};

// `settings` hold the plan where the technique is `auto`. Throws as make_estimator(). `progress` is
// told what is measured and the share that is done.
std::vector<LeaveOutCost> measure_cost(
    const PreparedScene& scene, const RenderSettings& settings, const CostOptions& options,
    const std::function<void(const char*, double)>& progress = {});

}  // namespace midway
