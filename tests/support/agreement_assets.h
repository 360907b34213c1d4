// How the scenes of assets/ are compared: which families and exponents, with how many samples, and
// how small the standard error of the image's mean has to become. Samples were chosen by measuring:
// some of these scenes need a thousand times as many as others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrator/strategy.h"

namespace midway::test {

struct AssetRow {
    Families families;
    std::vector<double> exponents;  // from the same paths
    double relative_error = 0.001;  // standard error of the mean, to be reached
    std::uint64_t passes = 1024;    // per seed, of 24 x 24 pixels
    int seeds = 16;                 // half as many again where the error asked for is missed
    // Blocks of a caustic that these families find by chance alone are lit by a few samples of each
    // render, and too skewed for a z-test; the whole image is not.
    bool blocks = true;
};

struct AssetPlan {
    std::string file;  // assets/FILE.glb
    std::string sky;   // as in `--sky`
    std::vector<AssetRow> rows;
};

std::vector<AssetPlan> asset_plans();

// "EN": initials of emitter, next-event, light, connect.
Families families_by_initials(const std::string& initials);

}  // namespace midway::test
