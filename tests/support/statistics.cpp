#include "support/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace midway::test {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Both expansions need a multiple of sqrt(a) terms; this covers a up to some 1e9.
constexpr int kMaxTerms = 1'000'000;

// x^a e^-x / Gamma(a), in logarithms since the factors overflow long before the product does.
double gamma_prefactor(double a, double x) {
    return std::exp(a * std::log(x) - x - std::lgamma(a));
}

// P by its series, for x < a + 1 (Abramowitz and Stegun 6.5.29).
double gamma_series(double a, double x) {
    double term = 1 / a;
    double sum = term;
    for (int n = 1; n < kMaxTerms; ++n) {
        term *= x / (a + n);
        sum += term;
        if (term < sum * kEpsilon) break;
    }
    return sum * gamma_prefactor(a, x);
}

// Q by its continued fraction, for x >= a + 1 (Abramowitz and Stegun 6.5.31), evaluated from the
// front with the recurrence of Lentz 1976.
double gamma_fraction(double a, double x) {
    constexpr double tiny = std::numeric_limits<double>::min() / kEpsilon;
    double b = x + 1 - a;
    double c = 1 / tiny;
    double d = 1 / b;
    double product = d;
    for (int n = 1; n < kMaxTerms; ++n) {
        const double numerator = -n * (n - a);
        b += 2;
        d = numerator * d + b;
        if (std::abs(d) < tiny) d = tiny;
        d = 1 / d;
        c = b + numerator / c;
        if (std::abs(c) < tiny) c = tiny;
        product *= d * c;
        if (std::abs(d * c - 1) < kEpsilon) break;
    }
    return product * gamma_prefactor(a, x);
}

void check_gamma_arguments(double a, double x) {
    if (!(a > 0) || !(x >= 0)) {
        throw std::invalid_argument("incomplete gamma outside a > 0, x >= 0");
    }
}

}  // namespace

double gamma_p(double a, double x) {
    check_gamma_arguments(a, x);
    if (x == 0) return 0;
    if (std::isinf(x)) return 1;
    return x < a + 1 ? gamma_series(a, x) : 1 - gamma_fraction(a, x);
}

double gamma_q(double a, double x) {
    check_gamma_arguments(a, x);
    if (x == 0) return 1;
    if (std::isinf(x)) return 0;
    return x < a + 1 ? 1 - gamma_series(a, x) : gamma_fraction(a, x);
}

double chi_square_tail(double statistic, double degrees_of_freedom) {
    return gamma_q(degrees_of_freedom / 2, statistic / 2);
}

ChiSquare chi_square_test(std::span<const double> observed, std::span<const double> expected,
                          double min_expected) {
    if (observed.size() != expected.size() || !(min_expected > 0)) {
        throw std::invalid_argument("chi-square needs as many observed as expected counts");
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (!(expected[i] >= 0) || !(observed[i] >= 0) || std::isinf(expected[i])) {
            throw std::invalid_argument("chi-square counts must be finite and not negative");
        }
    }
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return expected[i] < expected[j]; });

    struct Pool {
        double observed = 0;
        double expected = 0;
    };
    ChiSquare result;
    std::vector<Pool> pools;
    Pool pool;
    for (std::size_t i : order) {
        if (expected[i] == 0) result.impossible += observed[i];
        pool.observed += observed[i];
        pool.expected += expected[i];
        if (pool.expected >= min_expected) {
            pools.push_back(pool);
            pool = {};
        }
    }
    // What is left over was too little for a pool of its own.
    if (!pools.empty()) {
        pools.back().observed += pool.observed;
        pools.back().expected += pool.expected;
    }
    for (const Pool& p : pools) {
        const double difference = p.observed - p.expected;
        result.statistic += difference * difference / p.expected;
    }
    result.degrees_of_freedom = static_cast<int>(pools.size()) - 1;
    if (result.degrees_of_freedom < 1) {
        throw std::invalid_argument("chi-square needs two pools at least; take more samples");
    }
    result.p_value = chi_square_tail(result.statistic, result.degrees_of_freedom);
    return result;
}

double z_test(const Estimate& a, const Estimate& b) { return two_sided_p(z_score(a, b)); }

}  // namespace midway::test
