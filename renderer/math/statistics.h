// Tests of means of random numbers: the normal distribution, z-tests, and the correction for many
// tests at once. A p-value is the chance that a correct program does as badly; a test fails where
// it lies under a stated level (its false-alarm rate).
// Sources: Abramowitz and Stegun 1964 (26.2.23); Sidak 1967 (many tests at once); Welford 1962
// (running variance). Bad arguments throw std::invalid_argument.
#pragma once

#include <cstdint>

namespace midway {

double normal_cdf(double x);
double normal_quantile(double p);  // inverse of normal_cdf, 0 < p < 1

// Level for each of `tests` independent tests such that all together raise a false alarm with
// chance `alpha`.
double sidak_level(double alpha, std::int64_t tests);

// Mean and its standard error.
struct Estimate {
    double mean = 0;
    double standard_error = 0;
};

// Difference of two independent estimates in units of its standard error. Two exact estimates give
// 0 where they are equal and infinity where not.
double z_score(const Estimate& a, const Estimate& b);

// Two-sided p-value of a normal deviate.
double two_sided_p(double z);

// Mean and variance of a stream of numbers.
struct RunningMean {
    std::int64_t count = 0;
    double mean = 0;
    double squares = 0;  // sum of squared deviations from the mean

    void add(double x);
    double variance() const;    // of one sample, unbiased; 0 under two samples
    Estimate estimate() const;  // of the mean
};

}  // namespace midway
