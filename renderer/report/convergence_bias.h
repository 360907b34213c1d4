// Is a technique right on average? Relative difference of image means, tested by Student's t: the
// halves A and B of K seeds are 2K independent scrambles, so their spread measures the error of
// their mean whatever the sampler, and the reference's own error joins by Welch's formula (1947).
// The test needs image means near normal: it holds where many samples carry the mean, and fails
// where a handful of fireflies do.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "report/comparison.h"
#include "report/reference.h"

namespace midway {

// The chance that a run flags any of its techniques although all are right.
constexpr double bias_false_alarm = 1e-3;

// Why a difference is no fault, and which way the technique's mean may then differ: what it misses
// makes it too dark, never too bright.
struct BiasExcuse {
    std::string why;
    bool dark = false, bright = false;
};

struct BiasTest {
    std::vector<double> luminances;  // mean of the image, of each half of each seed
    // One whose own error is not known is taken to be as noisy as the technique: taken as exact, it
    // would have right techniques called biased.
    MeasuredMean reference;
    std::int64_t comparisons = 1;  // techniques of the run, of all scenes of a suite
    BiasExcuse excuse;
};

BiasVerdict judge_bias(const BiasTest& test);

}  // namespace midway
