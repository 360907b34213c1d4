#include "report/convergence_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace midway {
namespace {

struct Shape {
    double error = 1, slope = -1, noise = 0;
    int points = 25;
    double first = 0.01;
};

// relMSE = error t^slope, four points in each doubling. The noise is common to all points of a
// seed, as it would be where each image goes on from the one before.
std::vector<ErrorCurve> curves_of(const Shape& s, int seeds, unsigned number = 1) {
    std::mt19937_64 random(number);
    std::normal_distribution<double> normal;
    std::vector<ErrorCurve> curves(seeds);
    for (int k = 0; k < seeds; ++k) {
        const double level = std::exp(s.noise * normal(random));
        const double tilt = 0.1 * s.noise * normal(random);
        for (int i = 0; i < s.points; ++i) {
            ErrorPoint p;
            p.seconds = s.first * std::exp2(0.25 * i) * (1 + 0.001 * k);
            p.cpu_seconds = 2 * p.seconds;
            p.spp = std::uint64_t(std::llround(1e4 * p.seconds));
            p.relmse = s.error * level * std::pow(p.seconds, s.slope + tilt);
            p.relmse_trimmed = 0.5 * p.relmse;
            p.mse = 3 * p.relmse;
            p.smape = std::sqrt(p.relmse);
            curves[k].points.push_back(p);
        }
        curves[k].seed = std::uint64_t(k);
    }
    return curves;
}

TEST(ConvergenceFit, FindsTheSlopeOfAPowerLaw) {
    for (const double slope : {-0.5, -1.0, -1.4}) {
        const ConvergenceFit fit = fit_slope(curves_of({2, slope}, 3), 0);
        EXPECT_NEAR(fit.slope.value, slope, 2e-3);
        EXPECT_NEAR(fit.slope_spp.value, slope, 1e-2);
        EXPECT_GE(fit.points, 24);
    }
}

// 95 % intervals hold the truth in 95 % of 400 runs; the count is within 4.4 standard errors
// (false alarm 1e-5; the seeds are fixed). Residuals of one curve's points would give intervals
// some ten times too narrow, because their noise is common.
TEST(ConvergenceFit, IntervalsHoldAsOftenAsTheySay) {
    int slope = 0, ratio = 0;
    constexpr int runs = 400;
    for (int i = 0; i < runs; ++i) {
        const auto a = curves_of({1, -1, 0.2}, 4, 2 * i + 1);
        const auto b = curves_of({0.25, -1, 0.2}, 4, 2 * i + 2);
        const ConvergenceFit fit = fit_slope(a, 0);
        slope += fit.slope.lower <= -1 && -1 <= fit.slope.upper;
        const Interval e = relative_efficiency(a, b, EfficiencyMetric::relmse);
        ratio += e.lower <= 4 && 4 <= e.upper;
    }
    const double margin = 4.4 * std::sqrt(0.95 * 0.05 * runs);
    EXPECT_NEAR(slope, 0.95 * runs, margin);
    EXPECT_NEAR(ratio, 0.95 * runs, margin);
}

TEST(ConvergenceFit, OneSeedHasNoInterval) {
    const auto curves = curves_of({}, 1);
    const ConvergenceFit fit = fit_slope(curves, 0);
    EXPECT_NEAR(fit.slope.value, -1, 1e-6);
    EXPECT_TRUE(std::isnan(fit.slope.lower));
    EXPECT_TRUE(std::isnan(mean_curve(curves).front().relmse.upper));
    EXPECT_TRUE(std::isnan(relative_efficiency(curves, curves, EfficiencyMetric::relmse).upper));
}

TEST(ConvergenceFit, PointsBelowTheFloorHaveNoSay) {
    auto curves = curves_of({}, 2);
    for (ErrorCurve& c : curves)
        for (ErrorPoint& p : c.points)
            if (p.relmse < 5) p.relmse = p.seconds < 0.4 ? 0.3 : -0.3;  // noise around nothing
    const ConvergenceFit fit = fit_slope(curves, 5);
    EXPECT_NEAR(fit.slope.value, -1, 0.02);
    EXPECT_LT(fit.points, 20);
    EXPECT_TRUE(std::isnan(fit_slope(curves, 1e9).slope.value));
}

TEST(ConvergenceFit, MeanCurveIsTheMeanAtCommonTimes) {
    auto curves = curves_of({4}, 2);
    for (ErrorPoint& p : curves[1].points) p.relmse *= 3;
    curves[1].points.resize(20);
    curves.push_back({});  // begun, but not measured
    const std::vector<BandPoint> band = mean_curve(curves);
    EXPECT_GT(band.size(), 18u);
    EXPECT_NEAR(band.back().seconds, curves[1].points.back().seconds, 1e-12);
    for (const BandPoint& p : band) {
        EXPECT_NEAR(p.relmse.value * p.seconds, 8, 1e-9);
        EXPECT_GT(p.relmse.lower, 0);
        EXPECT_GT(p.relmse.upper, 2 * p.relmse.value);
        EXPECT_NEAR(p.spp, 1e4 * p.seconds, 1 + 0.01 * p.spp);
    }
}

TEST(ConvergenceFit, TellsTheTimeToAnErrorOrThatItWasNotReached) {
    const auto band = mean_curve(curves_of({1, -1}, 2));
    const double last = band.back().seconds;
    EXPECT_NEAR(*time_to_reach(band, 7).seconds, 1.0 / 7, 1e-6);
    EXPECT_FALSE(time_to_reach(band, 7).at_most);
    EXPECT_FALSE(time_to_reach(band, 0.9 / last).seconds);
    EXPECT_TRUE(time_to_reach(band, 1e6).at_most);
}

TEST(ConvergenceFit, ErrorsToReachAreRoundAndWithinTheCurves) {
    std::vector<TechniqueResult> t(2);
    t[0].band = mean_curve(curves_of({0.01}, 2));
    t[1].band = mean_curve(curves_of({0.05}, 2));
    const std::vector<double> errors = errors_to_reach(t, unknown_number, 3);
    ASSERT_EQ(errors.size(), 3u);
    EXPECT_GT(errors[0], errors[1]);
    EXPECT_GE(errors[2], t[0].band.back().relmse.value);
    EXPECT_TRUE(std::abs(errors[2] - 0.03) < 1e-15 || std::abs(errors[2] - 0.01) < 1e-15);
    // Below the reference's own error no curve means anything.
    for (const double e : errors_to_reach(t, 0.2, 10)) EXPECT_GE(e, 0.2);
    EXPECT_EQ(errors_to_reach(t, 0.2, 3).size(), 3u);
}

// Stopped half a second into the fourth seed, a run still knows what three whole ones say.
TEST(ConvergenceFit, SeedsThatHardlyBeganAreLeftOut) {
    ConvergenceRun run;
    run.techniques.resize(2);
    for (size_t i = 0; i < 2; ++i)
        for (ErrorCurve& c : curves_of({i == 0 ? 1.0 : 0.2}, 4)) {
            const bool last = c.seed == 3;
            if (last) c.points.resize(i == 0 ? 2 : 1);
            run.techniques[i].seeds.push_back({c});
            run.techniques[i].seeds.back().seconds = c.points.back().seconds;
        }
    // The first technique alone has begun a fifth.
    run.techniques[0].seeds.push_back(run.techniques[0].seeds.back());
    leave_out_short_seeds(run);
    std::vector<std::vector<ErrorCurve>> curves(2);
    for (size_t i = 0; i < 2; ++i)
        for (const CurveRun& r : run.techniques[i].seeds) curves[i].push_back(r.curve);
    const auto whole = curves_of({1}, 3), other = curves_of({0.2}, 3);
    EXPECT_EQ(mean_curve(curves[0]).back().seconds, mean_curve(whole).back().seconds);
    EXPECT_EQ(mean_of_last(curves[0]).relmse, mean_of_last(whole).relmse);
    EXPECT_EQ(fit_slope(curves[0], 0).slope.lower, fit_slope(whole, 0).slope.lower);
    EXPECT_EQ(relative_efficiency(curves[0], curves[1], EfficiencyMetric::relmse).value,
              relative_efficiency(whole, other, EfficiencyMetric::relmse).value);
    // Curves that are to go on from where they were: all of them count.
    for (TechniqueRun& t : run.techniques) {
        t.seeds.resize(3);
        t.seeds[0].seconds *= 3;
    }
    leave_out_short_seeds(run);
    for (const TechniqueRun& t : run.techniques)
        for (const CurveRun& r : t.seeds) EXPECT_TRUE(r.curve.counts);
}

TEST(ConvergenceFit, EfficiencyIsTheRatioOfErrorTimesTime) {
    const auto a = curves_of({1}, 3), b = curves_of({0.2}, 3);
    const Interval e = relative_efficiency(a, b, EfficiencyMetric::relmse_trimmed);
    EXPECT_NEAR(e.value, 5, 1e-9);
    EXPECT_NEAR(e.lower, 5, 1e-6);
    EXPECT_TRUE(std::isnan(relative_efficiency({}, b, EfficiencyMetric::relmse).value));
}

TEST(ConvergenceFit, LastPointsAreAveraged) {
    auto curves = curves_of({1}, 2);
    curves[0].points.back().flip = 0.25;
    EXPECT_FALSE(mean_of_last(curves).flip);
    curves[1].points.back().flip = 0.75;
    const ErrorPoint p = mean_of_last(curves);
    EXPECT_DOUBLE_EQ(*p.flip, 0.5);
    EXPECT_NEAR(p.relmse * p.seconds, 1, 1e-2);
}

}  // namespace
}  // namespace midway
