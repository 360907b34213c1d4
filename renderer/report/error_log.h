// Errors of a film against a reference, as rows of one format: `midway render --error-log`,
// `midway compare` and the window's plot all measure with these functions.
#pragma once

#include <optional>
#include <string>

#include "report/error_point.h"
#include "report/reference.h"

namespace midway {

struct Elapsed {
    double seconds = 0, cpu_seconds = 0;
};

// The error of the film's mean. bias_z compares film_luminance() with the reference's (measured: z
// has root mean square 1.0 to 1.2 over 24 seeds of `light` and `bdpt:2`) and is NaN where one half
// is empty. Throws std::runtime_error where sizes differ.
ErrorPoint measure_error(const Reference& reference, const Film& film, const PassCounts& passes,
                         const Elapsed& elapsed, bool flip = false);

// The same numbers of an image alone, as a snapshot of a live render has it; bias_z, which needs
// the halves, is NaN.
ErrorPoint measure_error(const Reference& reference, const Image& image, std::uint64_t spp,
                         const Elapsed& elapsed, bool flip = false);

// relMSE of a film's mean with no reference: squared differences of the halves a, b (image/film.h)
// over a b, where it is above 0, in place of r^2: of independent halves the product's expectation
// is the squared mean, and a bright pixel in one half alone does not hide its own error, as it
// would in the square of the mean. Measured: on the safe side (twice too high) at 8 samples per
// pixel, within 20 % at 40. Infinite where one half is empty.
double estimate_relmse(const Film& film, const PassCounts& passes);

// The same number from the mean and its variance (image/film.h) alone, of every step-th pixel. Only
// the size of a - b is known then, which is enough where both halves hold as many passes; empty
// where they do not (measured: whichever sign is taken, single pixels spoil it by up to 100 times).
std::optional<double> estimate_relmse(const Image& mean, const Image& variance,
                                      const PassCounts& passes, size_t step = 1);

// The first number of passes above `passes` at which errors are measured: every pass up to 8, then
// four numbers in each doubling. Deterministic, so that a render that stops at an error always
// stops at the same sample.
std::uint64_t next_measured_pass(std::uint64_t passes);

// Text of convergence.csv. Numbers are written such that they read back as the same bits; an
// unknown one is empty.
std::string error_csv_header();
std::string error_csv_row(const std::string& technique, double exponent, std::uint64_t seed,
                          const ErrorPoint& point);

}  // namespace midway
