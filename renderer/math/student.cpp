#include "math/student.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "math/statistics.h"

namespace midway {
namespace {

// Continued fraction of I_x(a, b), quick where x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
    constexpr double tiny = 1e-300;
    const auto away_from_zero = [](double v) { return std::abs(v) < tiny ? tiny : v; };
    double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), f = d;
    for (int m = 1; m <= 1000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / away_from_zero(1 + even * d);
        c = away_from_zero(1 + even / c);
        f *= c * d;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / away_from_zero(1 + odd * d);
        c = away_from_zero(1 + odd / c);
        f *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return f;
}

// `rest` is 1 - x, so that neither loses digits.
double incomplete_beta(double a, double b, double x, double rest) {
    if (x <= 0) return 0;
    if (rest <= 0) return 1;
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log(rest));
    if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
    return 1 - front * beta_fraction(b, a, rest) / b;
}

}  // namespace

double student_two_sided_p(double t, double n) {
    if (!(n > 0)) throw std::invalid_argument("Student's t needs degrees of freedom above 0");
    if (std::isnan(t)) return 0;
    if (std::isinf(t)) return 0;
    const double square = t * t;
    return incomplete_beta(0.5 * n, 0.5, n / (n + square), square / (n + square));
}

double student_limit(double alpha, double n) {
    if (!(alpha > 0 && alpha < 1)) throw std::invalid_argument("limit outside 0 < alpha < 1");
    double low = 0, high = 1;
    while (student_two_sided_p(high, n) > alpha) high *= 2;
    for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (student_two_sided_p(middle, n) > alpha ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double normal_limit(double alpha) { return -normal_quantile(0.5 * alpha); }

double normal_deviate_of_student(double t, double n) {
    if (t == 0) return 0;
    const double p = std::clamp(student_two_sided_p(t, n), 1e-300, 1 - 1e-16);
    return std::copysign(normal_limit(p), t);
}

MeanInterval mean_interval(std::span<const double> values, double confidence) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (values.empty()) return {none, none, none};
    RunningMean m;
    for (const double v : values) m.add(v);
    if (m.count < 2) return {m.mean, none, none};
    const double half =
        student_limit(1 - confidence, double(m.count - 1)) * m.estimate().standard_error;
    return {m.mean, m.mean - half, m.mean + half};
}

}  // namespace midway
