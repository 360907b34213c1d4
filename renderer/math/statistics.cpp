#include "math/statistics.h"

#include <cmath>
#include <stdexcept>

namespace midway {

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

double normal_quantile(double p) {
    if (!(p > 0 && p < 1)) throw std::invalid_argument("normal quantile outside 0 < p < 1");
    if (p > 0.5) return -normal_quantile(1 - p);
    // Start within 4.5e-4 of the root (Abramowitz and Stegun 26.2.23), then take Halley steps.
    const double t = std::sqrt(-2 * std::log(p));
    double x = (2.515517 + t * (0.802853 + t * 0.010328)) /
                   (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) -
               t;
    for (int step = 0; step < 3; ++step) {
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::acos(-1.0));
        const double newton = (normal_cdf(x) - p) / density;
        x -= newton / (1 + 0.5 * x * newton);
    }
    return x;
}

double sidak_level(double alpha, std::int64_t tests) {
    if (!(alpha > 0 && alpha < 1) || tests < 1) {
        throw std::invalid_argument("Sidak level needs 0 < alpha < 1 and one test at least");
    }
    // 1 - (1 - alpha)^(1/n), without losing the digits of a small alpha.
    return -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

double z_score(const Estimate& a, const Estimate& b) {
    const double difference = a.mean - b.mean;
    const double error = std::hypot(a.standard_error, b.standard_error);
    if (error == 0 && difference == 0) return 0;
    return difference / error;
}

double two_sided_p(double z) {
    // A NaN is smaller than no level; it must not pass for agreement.
    return std::isnan(z) ? 0 : std::erfc(std::abs(z) / std::sqrt(2.0));
}

void RunningMean::add(double x) {
    ++count;
    const double difference = x - mean;
    mean += difference / static_cast<double>(count);
    squares += difference * (x - mean);
}

double RunningMean::variance() const {
    return count < 2 ? 0 : squares / static_cast<double>(count - 1);
}

Estimate RunningMean::estimate() const {
    if (count == 0) return {};
    return {mean, std::sqrt(variance() / static_cast<double>(count))};
}

}  // namespace midway
