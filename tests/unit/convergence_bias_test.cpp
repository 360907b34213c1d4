#include "report/convergence_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/statistics.h"
#include "math/student.h"

namespace midway {
namespace {

struct Run {
    double bias = 0, spread = 0.004, reference_error = 0.0005;
    int seeds = 3;
};

BiasTest run_of(const Run& r, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    BiasTest t;
    RunningMean parts;  // of the reference
    for (int i = 0; i < 8; ++i)
        parts.add(2 * (1 + std::sqrt(8.0) * r.reference_error * normal(random)));
    t.reference = {parts.estimate(), 7};
    for (int i = 0; i < 2 * r.seeds; ++i)
        t.luminances.push_back(2 * (1 + r.bias + r.spread * normal(random)));
    return t;
}

// 4000 right runs: |z| exceeds a limit of chance p as often as p says (each count within 4.4
// standard errors; false alarm 6e-5), with references of little and of much error. A z from the
// normal distribution in place of Student's t would exceed the limit of 1 % three times as often.
TEST(BiasVerdict, RaisesFalseAlarmsAsOftenAsItSays) {
    constexpr int runs = 4000;
    std::mt19937_64 random(11);
    for (const double reference_error : {0.0003, 0.003})
        for (const double p : {0.2, 0.05, 0.01}) {
            SCOPED_TRACE(p);
            int above = 0;
            for (int i = 0; i < runs; ++i)
                above += std::abs(judge_bias(run_of({0, 0.004, reference_error}, random)).z) >
                         normal_limit(p);
            EXPECT_NEAR(above, p * runs, 4.4 * std::sqrt(p * (1 - p) * runs));
        }
}

// A suite of 40 techniques, with a tenth of the noise of ten seconds: none may be flagged but the
// planted one. False alarm 1e-3 by design, with this seed none.
TEST(BiasVerdict, FlagsOnePlantedPercentAmongFortyTechniques) {
    std::mt19937_64 random(12);
    int flagged = 0, found = 0;
    for (int i = 0; i < 40; ++i) {
        BiasTest t = run_of({i == 17 ? 0.01 : 0.0, 0.0005, 0.0001}, random);
        t.comparisons = 40;
        const BiasVerdict v = judge_bias(t);
        flagged += v.flagged;
        found += i == 17 && v.flagged;
        EXPECT_NEAR(v.limit, normal_limit(sidak_level(1e-3, 40)), 1e-9);
        if (i == 17) EXPECT_NE(v.text.find("BIASED"), std::string::npos) << v.text;
    }
    EXPECT_EQ(flagged, 1);
    EXPECT_EQ(found, 1);
}

TEST(BiasVerdict, WhatATechniqueDoesNotCoverIsNoFault) {
    std::mt19937_64 random(13);
    BiasTest t = run_of({-0.3}, random);
    t.excuse = {"it does not cover what is seen in mirrors", true, false};
    const BiasVerdict v = judge_bias(t);
    EXPECT_GT(std::abs(v.z), v.limit);
    EXPECT_FALSE(v.flagged);
    EXPECT_TRUE(v.expected);
    EXPECT_NE(v.text.find("mirrors"), std::string::npos);
    // What it misses makes it darker, never brighter.
    t = run_of({+0.3}, random);
    t.excuse = {"it does not cover what is seen in mirrors", true, false};
    EXPECT_TRUE(judge_bias(t).flagged);
    t.excuse = {"the reference does not cover the scene", false, true};
    EXPECT_FALSE(judge_bias(t).flagged);
}

TEST(BiasVerdict, TheReferencesOwnErrorCounts) {
    std::mt19937_64 random(14);
    BiasTest t = run_of({0.01, 1e-5, 0}, random);
    EXPECT_TRUE(judge_bias(t).flagged);
    t.reference.estimate.standard_error = 0.02 * t.reference.estimate.mean;
    EXPECT_FALSE(judge_bias(t).flagged);
}

// A reference of as many samples that keeps its error to itself: right techniques are flagged no
// more often than by one that tells it. 2000 runs, limit of chance 1 % (false alarm 1e-5).
TEST(BiasVerdict, AReferenceOfUnknownErrorIsNotTakenAsExact) {
    std::mt19937_64 random(15);
    int above = 0;
    for (int i = 0; i < 2000; ++i) {
        BiasTest t = run_of({0, 0.004, 0.004 / std::sqrt(6.0)}, random);
        t.reference.freedom = 0;
        t.reference.estimate.standard_error = 0;
        above += std::abs(judge_bias(t).z) > normal_limit(0.01);
    }
    EXPECT_LT(above, 20 + 4.4 * std::sqrt(20.0));
    BiasTest t = run_of({0.05}, random);
    t.reference = {{2, 0}, 0};
    EXPECT_TRUE(judge_bias(t).flagged);
}

TEST(BiasVerdict, SaysWhereItCannotTell) {
    BiasTest t;
    t.reference = {{1, 0}, 0};
    EXPECT_FALSE(judge_bias(t).flagged);
    t.luminances = {1.5};
    EXPECT_TRUE(std::isnan(judge_bias(t).z));
    t.luminances = {1.5, std::nan("")};  // one pass: half B is empty
    EXPECT_TRUE(std::isnan(judge_bias(t).z));
    t.luminances = {0, 0};
    t.reference = {};
    EXPECT_FALSE(judge_bias(t).flagged);
}

}  // namespace
}  // namespace midway
