// The recursion of integrator/mis.h against the direct form, with no scene at all: made-up
// densities of every size, delta vertices, families taken out, several light subpaths, and next
// event and emission that choose points by different densities.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "report/direct_form.h"
#include "report/whole_path_recursion.h"
#include "support/tier.h"

namespace midway::test {
namespace {

constexpr double exponents[] = {0, 0.5, 1, 2, 8, 32};

struct MadeUp {
    double low = -6, high = 6;  // decades of each density and of each g
    int edges = 15;
    double deltas = 0.25;
    bool hittable = true;
};

PathPdfs make_up(std::mt19937_64& random, const MadeUp& m) {
    std::uniform_real_distribution<double> decade(m.low, m.high), unit(0, 1);
    const auto number = [&] { return std::pow(10.0, decade(random)); };
    PathPdfs p;
    p.vertices.resize(m.edges + 1);
    for (int i = 0; i <= m.edges; ++i) {
        VertexPdfs& v = p.vertices[i];
        v = {number(), number(), number(), number()};
        v.delta = i > 0 && i < m.edges && unit(random) < m.deltas;
    }
    p.emission = number();
    p.next_event = number();
    p.hittable = m.hittable;
    return p;
}

double sum_of(const std::vector<double>& weights) {
    double sum = 0;
    for (const double w : weights) sum += w;
    return sum;
}

void expect_same(const PathPdfs& p, const PathSetting& setting) {
    for (const double b : exponents) {
        const std::vector<double> expected = direct_weights(p, setting, b);
        const std::vector<double> found = recursive_weights(p, p, setting, b);
        const bool any = sum_of(expected) > 0;
        ASSERT_NEAR(sum_of(expected), any ? 1 : 0, 1e-9);
        ASSERT_NEAR(sum_of(found), any ? 1 : 0, 1e-9)
            << "b " << b << ", " << p.edges() << " edges, families " << to_string(setting.families);
        for (size_t i = 0; i < expected.size(); ++i)
            ASSERT_NEAR(found[i], expected[i], 1e-9)
                << "b " << b << ", strategy " << describe({int(i) + 1, p.edges() - int(i)})
                << ", families " << to_string(setting.families);
    }
}

Families families_of_bits(unsigned bits) {
    return {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
}

// Densities of 1e-6 to 1e6 per solid angle and as much again for g: 1e-12 to 1e12 per area.
TEST(MisRecursion, EqualsTheDirectFormForMadeUpDensities) {
    std::mt19937_64 random(1);
    for (int i = 0; i < by_tier(20000, 400000); ++i) {
        MadeUp m;
        m.edges = 2 + int(random() % 14);
        m.deltas = i % 3 * 0.25;
        m.hittable = random() % 4 != 0;
        PathSetting setting;
        setting.families = families_of_bits(1 + random() % 15);
        if (i % 2) setting.families = {};
        setting.light_subpaths = i % 5 ? std::pow(10.0, double(random() % 7)) : 1;
        setting.direct_share = i % 4 ? std::pow(10.0, -0.5 * double(random() % 4)) : 1;
        setting.connection_share = i % 3 ? std::pow(0.5, double(random() % 4)) : 1;
        setting.choices = i % 2 ? 8 : 1 + int(random() % 50);
        ASSERT_NO_FATAL_FAILURE(expect_same(make_up(random, m), setting)) << "path " << i;
    }
}

TEST(MisRecursion, HoldsForEverySubsetOfFamilies) {
    std::mt19937_64 random(2);
    for (unsigned bits = 1; bits < 16; ++bits)
        for (int i = 0; i < 400; ++i) {
            MadeUp m;
            m.low = -2;
            m.high = 2;
            m.edges = 2 + i % 7;
            m.deltas = i % 2 * 0.2;
            m.hittable = i % 3 != 0;
            PathSetting setting;
            setting.families = families_of_bits(bits);
            setting.light_subpaths = 17;
            ASSERT_NO_FATAL_FAILURE(expect_same(make_up(random, m), setting));
        }
}

// A light picked a thousand times more often by one of the two, in paths where both matter.
TEST(MisRecursion, TellsNextEventsDensityFromEmissions) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 2000; ++i) {
        MadeUp m;
        m.low = -0.3;
        m.high = 0.3;
        m.edges = 2 + i % 5;
        m.deltas = 0;
        PathPdfs p = make_up(random, m);
        p.emission = 0.5;
        p.next_event = p.emission * std::pow(10.0, i % 7 - 3);
        ASSERT_NO_FATAL_FAILURE(expect_same(p, {}));
    }
}

// Every density the same: the weights are the shares of the sample counts. Vertices first_delta ..
// last_delta scatter by delta lobes.
void expect_shares(const PathSetting& setting, const std::vector<double>& counts,
                   int last_delta = 0, int first_delta = 1) {
    PathPdfs p;
    p.vertices.resize(counts.size());
    for (int i = first_delta; i <= last_delta; ++i) p.vertices[static_cast<size_t>(i)].delta = true;
    const std::vector<double> w = recursive_weights(p, p, setting, 1);
    ASSERT_EQ(counts.size(), w.size());
    for (size_t i = 0; i < w.size(); ++i)
        EXPECT_NEAR(w[i], counts[i] / sum_of(counts), 1e-12) << "camera vertices " << i + 1;
}

TEST(MisRecursion, CountsTheSamplesOfLightTracing) {
    PathSetting setting;
    setting.light_subpaths = 1000;
    expect_shares(setting, {1000, 1, 1, 1, 1});
}

// Not every camera sample connects.
TEST(MisRecursion, CountsTheSamplesThatConnect) {
    PathSetting setting;
    setting.connection_share = 0.25;
    expect_shares(setting, {1, 0.25, 0.25, 1, 1});
}

// The first rough surface has them many times over.
TEST(MisRecursion, CountsWhatTheFirstRoughSurfaceChoosesFrom) {
    PathSetting setting;
    setting.connection_share = 0.5;
    setting.choices = 8;
    expect_shares(setting, {1, 4, 0.5, 0.5, 1, 1});
    // Seen in a mirror: light tracing cannot make the path, and nothing connects at the mirror.
    expect_shares(setting, {0, 0, 4, 0.5, 1, 1}, 1);
    expect_shares(setting, {0, 0, 0, 4, 1, 1}, 2);
    // A mirror behind the first rough surface.
    expect_shares(setting, {1, 0, 0, 0.5, 0.5, 1, 1}, 2, 2);
}

// Of direct light alone.
TEST(MisRecursion, CountsAShareOfLightTracingOfDirectLight) {
    PathSetting setting;
    setting.light_subpaths = 1000;
    setting.direct_share = 0.1;
    expect_shares(setting, {100, 1, 1});
    expect_shares(setting, {1000, 1, 1, 1});
}

TEST(MisRecursion, NaiveWeightsAreUniformOverFeasibleStrategies) {
    std::mt19937_64 random(4);
    MadeUp m;
    m.edges = 5;
    m.deltas = 0;
    PathPdfs p = make_up(random, m);
    PathSetting setting;
    setting.light_subpaths = 64;
    for (const double w : recursive_weights(p, p, setting, 0)) EXPECT_NEAR(w, 1.0 / 6, 1e-12);
    p.hittable = false;          // five are left
    p.vertices[2].delta = true;  // its two edges cannot connect: three are left
    const std::vector<double> w = recursive_weights(p, p, setting, 0);
    const double expected[] = {1.0 / 3, 0, 0, 1.0 / 3, 1.0 / 3, 0};
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(w[i], expected[i], 1e-12) << i;
}

// A strategy that never draws the path (density zero) counts as infeasible, for exponent 0 as well.
TEST(MisRecursion, LeavesOutStrategiesOfZeroDensity) {
    PathPdfs p;
    p.vertices.resize(5);
    p.vertices[4].camera_w = 0;  // the camera's walk never finds the light
    for (const double b : exponents) {
        const std::vector<double> expected = direct_weights(p, {}, b);
        const std::vector<double> found = recursive_weights(p, p, {}, b);
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(found[i], expected[i], 1e-12) << b;
    }
}

TEST(MisRecursion, NoRangeOfDensitiesOverflows) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 2000; ++i) {
        MadeUp m;
        m.low = -10;
        m.high = 10;
        m.deltas = 0;
        const PathPdfs p = make_up(random, m);
        for (const double b : {0.5, 3.0, 8.0, 32.0}) {
            const std::vector<double> expected = direct_weights(p, {}, b);
            const std::vector<double> found = recursive_weights(p, p, {}, b);
            for (size_t s = 0; s < found.size(); ++s) ASSERT_NEAR(found[s], expected[s], 1e-9);
        }
    }
}

}  // namespace
}  // namespace midway::test
