// The tree over lamps that next event walks down. The frequency test's false alarm is 1e-6 with a
// fixed seed; everything else is exact.
#include "scene/light_tree.h"

#include <gtest/gtest.h>

#include <random>

#include "math/statistics.h"
#include "support/tier.h"

namespace midway::test {
namespace {

struct Lamps {
    std::vector<LightBounds> bounds;
    std::vector<double> weights;
};

// Small lamps in a cube, in clusters, of very different weight; every seventh is dark.
Lamps make_lamps(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(-1, 1);
    Lamps l;
    for (int i = 0; i < count; ++i) {
        const vec3 at = 0.8f * vec3(u(random), u(random), u(random));
        const vec3 size = 0.01f * vec3(1 + u(random), 1 + u(random), 1 + u(random));
        const vec3 axis = glm::normalize(vec3(u(random), u(random), u(random)) + vec3(0, 0, 0.01f));
        l.bounds.push_back({at, at + size, axis, i % 3 == 0});
        l.weights.push_back(i % 7 == 3 ? 0.0 : std::pow(10.0, 3 * u(random)));
    }
    return l;
}

std::vector<vec3> references() {
    return {vec3(0), vec3(0.5f, -0.7f, 0.2f), vec3(3, 1, -20), vec3(1e-3f, 0, 0.9f)};
}

TEST(LightTree, ProbabilitiesSumToOne) {
    for (const int count : {1, 2, 7, 8, 9, 64, 65, 1000, 20'000}) {
        Lamps l = make_lamps(count, 5);
        l.weights[0] = 1;
        LightTree tree;
        tree.build(l.bounds, l.weights);
        for (const vec3& r : references()) {
            double sum = 0;
            for (int i = 0; i < count; ++i) {
                const double p = tree.probability(i, r);
                EXPECT_EQ(p > 0, l.weights[size_t(i)] > 0);
                sum += p;
            }
            EXPECT_NEAR(sum, 1, 1e-5) << count;  // sums of float shares
        }
    }
}

TEST(LightTree, SamplesComeWithTheirProbability) {
    const Lamps l = make_lamps(3000, 6);
    LightTree tree;
    tree.build(l.bounds, l.weights);
    for (const vec3& r : references())
        for (int i = 0; i < 5000; ++i) {
            double p = 0;
            const int light = tree.sample(r, (i + 0.5) / 5000, p);
            ASSERT_GE(light, 0);
            EXPECT_EQ(p, tree.probability(light, r));
        }
}

// Equally spaced u meet each lamp as often as its probability says, up to the parts at the ends of
// the few intervals that belong to it.
TEST(LightTree, FrequenciesAreTheProbabilities) {
    const Lamps l = make_lamps(300, 7);
    LightTree tree;
    tree.build(l.bounds, l.weights);
    const int n = by_tier(200'000, 2'000'000);
    for (const vec3& r : references()) {
        std::vector<int> met(l.weights.size());
        for (int i = 0; i < n; ++i) {
            double p = 0;
            ++met[size_t(tree.sample(r, (i + 0.5) / n, p))];
        }
        for (size_t i = 0; i < met.size(); ++i)
            EXPECT_NEAR(met[i], n * tree.probability(int(i), r), 3) << i;
    }
}

// What the tree is for: a lamp close by is picked far more often than by its power.
TEST(LightTree, NearAndFacingLampsComeFirst) {
    Lamps l = make_lamps(1000, 8);
    std::fill(l.weights.begin(), l.weights.end(), 1.0);
    l.bounds[10] = {vec3(2), vec3(2.01f), {0, 0, 1}, false};
    LightTree tree;
    tree.build(l.bounds, l.weights);
    EXPECT_GT(tree.probability(10, vec3(2, 2, 2.1f)), 0.2);       // in front of it
    EXPECT_LT(tree.probability(10, vec3(2, 2, 1.9f)), 0.05);      // behind it
    EXPECT_LT(tree.probability(10, vec3(-1, -1, -1)), 2 * 1e-3);  // far away
}

TEST(LightTree, NewWeightsGiveTheTreeThatBuildingWould) {
    Lamps l = make_lamps(2000, 9);
    LightTree tree, fresh;
    tree.build(l.bounds, l.weights);
    for (double& w : l.weights) w *= w;
    tree.reweigh(l.weights);
    fresh.build(l.bounds, l.weights);
    EXPECT_TRUE(tree == fresh);
}

// Weights and distances at the ends of float: probabilities stay probabilities.
TEST(LightTree, ExtremesStayFinite) {
    for (const double scale : {1e-36, 1e-18, 1.0, 1e18, 1e36}) {
        Lamps l = make_lamps(100, 10);
        for (double& w : l.weights) w *= scale;
        LightTree tree;
        tree.build(l.bounds, l.weights);
        for (const float far : {0.0f, 1e-20f, 1.0f, 1e18f, 1e25f}) {
            double p = 0;
            const int light = tree.sample(vec3(far, 0, 0), 0.7, p);
            ASSERT_GE(light, 0);
            EXPECT_TRUE(p > 0 && p <= 1) << scale << " " << far;
        }
        // At a lamp's very place.
        double p = 0;
        ASSERT_GE(tree.sample(l.bounds[1].lower, 0.9, p), 0);
        EXPECT_TRUE(p > 0 && p <= 1) << scale;
    }
}

TEST(LightTree, WithoutLampsThereIsNothingToPick) {
    LightTree tree;
    tree.build({}, {});
    double p = 0;
    EXPECT_EQ(tree.sample(vec3(0), 0.5, p), -1);
    tree.build({{vec3(0), vec3(1)}}, {0});
    EXPECT_EQ(tree.sample(vec3(0), 0.5, p), -1);
    EXPECT_EQ(tree.probability(0, vec3(0)), 0);
}

}  // namespace
}  // namespace midway::test
