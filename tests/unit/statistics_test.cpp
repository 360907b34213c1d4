// The tests' own instruments: reference values from 30-digit arithmetic, false-alarm rates by
// simulation with fixed seeds, and wrong densities that must be found.
#include "support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "support/shared_data.h"
#include "support/temp_dir.h"

namespace midway::test {
namespace {

void expect_relative(double value, double reference, double tolerance) {
    EXPECT_NEAR(value / reference, 1, tolerance) << value << " against " << reference;
}

TEST(IncompleteGamma, MatchesReferenceValuesInBothTails) {
    struct Reference {
        double a, x, p, q;
    };
    const Reference references[] = {
        {0.5, 0.1, 0.34527915398142298, 0.65472084601857702},
        {1, 1, 0.63212055882855768, 0.36787944117144232},
        {2.5, 9, 0.99705359541211971, 0.0029464045878802904},
        {10, 3, 0.0011024881301154797, 0.99889751186988452},
        {100, 120, 0.97213626010947934, 0.027863739890520661},
        {1000, 900, 0.00054990226571178292, 0.99945009773428822},
        {50000, 50500, 0.98713115962276633, 0.01286884037723367},
        {3, 60, 1.0, 1.6295866529378224e-23},
    };
    for (const Reference& r : references) {
        SCOPED_TRACE(testing::Message() << "a " << r.a << " x " << r.x);
        // exp(a log x - x - lgamma a) loses about log10(a) digits.
        const double tolerance = 1e-14 * std::max(10.0, r.a * std::log(r.x));
        expect_relative(gamma_p(r.a, r.x), r.p, tolerance);
        expect_relative(gamma_q(r.a, r.x), r.q, tolerance);
    }
}

TEST(IncompleteGamma, HasItsLimitsAndRefusesWhatIsOutside) {
    EXPECT_EQ(gamma_p(2, 0), 0);
    EXPECT_EQ(gamma_q(2, 0), 1);
    EXPECT_EQ(gamma_q(2, std::numeric_limits<double>::infinity()), 0);
    EXPECT_THROW(gamma_p(0, 1), std::invalid_argument);
    EXPECT_THROW(gamma_q(1, -1), std::invalid_argument);
    EXPECT_THROW(gamma_q(1, std::nan("")), std::invalid_argument);
}

TEST(Normal, MatchesReferenceValues) {
    expect_relative(normal_cdf(-8), 6.2209605742717841e-16, 1e-12);
    expect_relative(normal_cdf(-3), 0.0013498980316300945, 1e-13);
    expect_relative(normal_cdf(0.5), 0.6914624612740131, 1e-14);
    expect_relative(normal_quantile(0.975), 1.9599639845400542, 1e-13);
    expect_relative(normal_quantile(1e-3), -3.0902323061678135, 1e-13);
    expect_relative(normal_quantile(1e-15), -7.9413453261709968, 1e-12);
    EXPECT_NEAR(normal_quantile(0.5), 0, 1e-15);
    EXPECT_THROW(normal_quantile(0), std::invalid_argument);
    EXPECT_THROW(normal_quantile(1), std::invalid_argument);
}

TEST(Sidak, KeepsTheDigitsOfSmallLevels) {
    EXPECT_DOUBLE_EQ(sidak_level(0.01, 1), 0.01);
    expect_relative(sidak_level(0.01, 1000), 1.0050285349045253e-5, 1e-13);
    expect_relative(sidak_level(1e-6, 1'000'000), 1.0000004999998333e-12, 1e-13);
}

TEST(ChiSquare, MatchesAWorkedExample) {
    const std::vector<double> observed = {18, 22, 31, 29};
    const std::vector<double> expected = {25, 25, 25, 25};
    const ChiSquare result = chi_square_test(observed, expected);
    EXPECT_DOUBLE_EQ(result.statistic, 4.4);
    EXPECT_EQ(result.degrees_of_freedom, 3);
    expect_relative(result.p_value, 0.22138538718948814, 1e-13);
}

TEST(ChiSquare, PoolsSmallCells) {
    const std::vector<double> observed = {1, 50, 0, 3, 2, 44, 1};
    const std::vector<double> expected = {2, 47, 0, 1, 2, 45, 4};
    // Sorted: 0 1 2 2 make one pool of 5; 4 joins 45; 47 stands alone.
    const ChiSquare result = chi_square_test(observed, expected);
    EXPECT_EQ(result.degrees_of_freedom, 2);
    EXPECT_DOUBLE_EQ(result.statistic, 1.0 / 5 + 16.0 / 49 + 9.0 / 47);
}

TEST(ChiSquare, LosesNoCellThatFillsNoPool) {
    const std::vector<double> observed = {4, 3, 2, 5, 10};
    const std::vector<double> expected = {3, 3, 3, 3, 3};
    // Pools of 6 and 6; the last 3 join the second.
    const ChiSquare result = chi_square_test(observed, expected);
    EXPECT_EQ(result.degrees_of_freedom, 1);
    EXPECT_DOUBLE_EQ(result.statistic, 1.0 / 6 + 64.0 / 9);
}

TEST(ChiSquare, CountsTheImpossible) {
    const std::vector<double> observed = {2, 49, 49};
    const std::vector<double> expected = {0, 50, 50};
    EXPECT_EQ(chi_square_test(observed, expected).impossible, 2);
}

TEST(ChiSquare, RefusesTooLittleData) {
    const std::vector<double> few = {1, 1};
    const std::vector<double> other = {1, 1, 1};
    EXPECT_THROW(chi_square_test(few, few), std::invalid_argument);
    EXPECT_THROW(chi_square_test(few, other), std::invalid_argument);
}

// Draws `samples` cells of 64 with probabilities rising linearly, and tests them against the same
// density with one cell's probability scaled.
double p_value_of_linear_density(unsigned seed, int samples, double scale_of_one_cell) {
    std::mt19937 engine(seed);
    std::vector<double> probability(64), observed(64), expected(64);
    for (int i = 0; i < 64; ++i) probability[i] = (i + 1) / (64.0 * 65 / 2);
    std::discrete_distribution<int> distribution(probability.begin(), probability.end());
    for (int i = 0; i < samples; ++i) ++observed[distribution(engine)];
    for (int i = 0; i < 64; ++i) expected[i] = samples * probability[i];
    expected[40] *= scale_of_one_cell;
    return chi_square_test(observed, expected).p_value;
}

TEST(ChiSquare, RaisesFalseAlarmsAtItsLevel) {
    // 2000 tests at 5 %: the count is binomial, 100 +- 9.7; five standard deviations are allowed.
    int alarms = 0;
    for (unsigned seed = 0; seed < 2000; ++seed) {
        if (p_value_of_linear_density(seed, 2000, 1) < 0.05) ++alarms;
    }
    EXPECT_NEAR(alarms, 100, 49);
}

TEST(ChiSquare, FindsOneCellThatIsTenPercentWrong) {
    EXPECT_GT(p_value_of_linear_density(1, 1'000'000, 1), 1e-3);
    EXPECT_LT(p_value_of_linear_density(1, 1'000'000, 1.1), 1e-9);
}

TEST(ZTest, ComparesMeans) {
    EXPECT_DOUBLE_EQ(z_score({1.0, 0.3}, {2.0, 0.4}), -2);
    expect_relative(z_test({1.0, 0.3}, {2.0, 0.4}), 2 * normal_cdf(-2), 1e-13);
    EXPECT_EQ(z_test({1, 0}, {1, 0}), 1);
    EXPECT_EQ(z_test({1, 0}, {2, 0}), 0);
}

TEST(ZTest, NeverTakesNaNForAgreement) {
    const double nan = std::nan("");
    EXPECT_EQ(z_test({nan, 0.1}, {1, 0.1}), 0);
    EXPECT_EQ(z_test({1, nan}, {1, 0.1}), 0);
}

TEST(ZTest, RaisesFalseAlarmsAtItsLevel) {
    // 2000 tests at 5 %, as above.
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> uniform;
    int alarms = 0;
    for (int test = 0; test < 2000; ++test) {
        RunningMean a, b;
        for (int i = 0; i < 200; ++i) {
            a.add(uniform(engine));
            b.add(uniform(engine) * uniform(engine) * 2);
        }
        if (z_test(a.estimate(), b.estimate()) < 0.05) ++alarms;
    }
    EXPECT_NEAR(alarms, 100, 49);
}

TEST(RunningMean, KeepsItsDigitsFarFromZero) {
    RunningMean running;
    for (double x : {4.0, 7.0, 13.0, 16.0}) running.add(1e9 + x);
    EXPECT_DOUBLE_EQ(running.mean, 1e9 + 10);
    EXPECT_DOUBLE_EQ(running.variance(), 30);
    EXPECT_DOUBLE_EQ(running.estimate().standard_error, std::sqrt(7.5));
    EXPECT_EQ(RunningMean{}.estimate().standard_error, 0);
}

TEST(TempDir, IsThereOnlyAsLongAsItsObject) {
    std::filesystem::path path;
    {
        TempDir directory;
        path = directory.path();
        EXPECT_TRUE(std::filesystem::is_empty(path));
        std::filesystem::create_directories(directory / "a" / "b");
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(SharedData, SkipsWhereItIsAbsent) {
    MIDWAY_SKIP_WITHOUT_SHARED("scenes");
    EXPECT_TRUE(std::filesystem::is_directory(shared_path("scenes")));
}

}  // namespace
}  // namespace midway::test
