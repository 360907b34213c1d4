// Hypothesis tests for random estimators: those of math/statistics.h, and chi-square goodness of
// fit.
// Source: Abramowitz and Stegun 1964 (6.5.29, 6.5.31). Bad arguments throw std::invalid_argument.
#pragma once

#include <span>

#include "math/statistics.h"

namespace midway::test {

// Regularised incomplete gamma functions P(a, x) and Q = 1 - P, for a > 0, x >= 0. Both are
// computed without cancellation, so that small tails keep their digits.
double gamma_p(double a, double x);
double gamma_q(double a, double x);

// Chance that a chi-square variable of these degrees of freedom is at least `statistic`.
double chi_square_tail(double statistic, double degrees_of_freedom);

struct ChiSquare {
    double statistic = 0;
    int degrees_of_freedom = 0;
    double p_value = 1;
    double impossible = 0;  // observed where exactly nothing is expected; pooled as well
};

// Observed against expected counts, cell by cell. Cells with few expected counts are pooled,
// smallest first, until each pool expects at least `min_expected`. The expected counts are not
// rescaled: where they do not sum to the observed total (a density that does not integrate to one)
// the test fails.
ChiSquare chi_square_test(std::span<const double> observed, std::span<const double> expected,
                          double min_expected = 5);

// Two-sided p-value of z_score. The estimates must be near normal: average many samples first.
double z_test(const Estimate& a, const Estimate& b);

}  // namespace midway::test
