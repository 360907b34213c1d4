// Student's t distribution, for means of few independent numbers whose spread is measured from
// themselves. Sources: Abramowitz and Stegun 1964 (26.7.1, 26.5.8: the incomplete beta function as
// a continued fraction, run forwards as Lentz 1976 does). Bad arguments throw
// std::invalid_argument.
#pragma once

#include <span>

namespace midway {

// Chance that |t| is at least this large, for any number of degrees of freedom above 0.
double student_two_sided_p(double t, double degrees_of_freedom);

// The t that |t| exceeds with chance `alpha`, 0 < alpha < 1.
double student_limit(double alpha, double degrees_of_freedom);

// The deviate of a normal variable that is as rare as this t, with its sign: so that one limit
// serves for any number of degrees of freedom.
double normal_deviate_of_student(double t, double degrees_of_freedom);

// The normal deviate that |z| exceeds with chance `alpha`.
double normal_limit(double alpha);

// Mean of independent numbers with its confidence interval; NaN bounds where there is only one.
struct MeanInterval {
    double mean = 0, lower = 0, upper = 0;
};
MeanInterval mean_interval(std::span<const double> values, double confidence = 0.95);

}  // namespace midway
