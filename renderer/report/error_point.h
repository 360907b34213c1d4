// Error of one image against a reference, at one moment of its render: a point of a convergence
// curve and a row of convergence.csv.
#pragma once

#include <cstdint>
#include <optional>

namespace midway {

struct ErrorPoint {
    // Time spent rendering, by the clock and summed over the threads' processors. Measuring and
    // writing are left out.
    double seconds = 0, cpu_seconds = 0;
    std::uint64_t spp = 0;
    // As image/metrics.h has them, the reference's own variance subtracted from mse, relmse and
    // relmse_trimmed where it is known; so these three may be below zero where nothing but the
    // reference's noise is left, and rmse is then 0.
    double mse = 0, rmse = 0, relmse = 0, relmse_trimmed = 0, smape = 0;
    std::optional<double> flip;  // taken at the end of a curve only
    // Relative difference of the image means, and the same in standard errors.
    double bias = 0, bias_z = 0;
};

}  // namespace midway
