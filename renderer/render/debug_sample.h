// One sample computed again alone, contribution by contribution: --debug-pixel and bug reports.
#pragma once

#include "integrator/estimator.h"
#include "render/settings.h"

namespace midway {

struct DebugContribution {
    Contribution contribution;
    bool splat = false;
    int x = 0, y = 0;  // where it went
};

struct DebugSample {
    int x = 0, y = 0;
    std::uint64_t pass = 0;
    std::uint64_t light_subpath = 0;
    std::vector<DebugContribution> contributions;
};

// Sample number `pass` of a pixel, with the light subpath that it meets (whose splats go
// elsewhere).
DebugSample replay_sample(const Estimator& estimator, int x, int y, std::uint64_t pass);

}  // namespace midway
