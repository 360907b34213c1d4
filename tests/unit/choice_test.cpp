// Drawing one of many candidates as they come by.
#include "integrator/choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "support/statistics.h"

namespace midway::test {
namespace {

// Each candidate as often as its share of the importance, in whatever order: chi-square over three
// orders; false alarm 1e-4 for all of them.
TEST(Choice, DrawsInProportionToImportance) {
    std::vector<double> importance{0, 3, 1, 0, 8, 0.25, 4, 0};
    const double total = std::accumulate(importance.begin(), importance.end(), 0.0);
    std::mt19937_64 random(5);
    for (int order = 0; order < 3; ++order) {
        std::shuffle(importance.begin(), importance.end(), random);
        std::vector<double> counts(importance.size()), expected;
        for (int i = 0; i < 20000; ++i) {
            Choice<double> choice{.rest = double(random() >> 11) * 0x1p-53};
            size_t drawn = 0;
            for (size_t k = 0; k < importance.size(); ++k)
                if (choice.offer(importance[k])) drawn = k;
            ++counts[drawn];
            ASSERT_DOUBLE_EQ(total / importance[drawn], choice.factor());
        }
        std::erase_if(counts, [](double c) { return c == 0; });
        for (const double x : importance)
            if (x > 0) expected.push_back(20000 * x / total);
        ASSERT_EQ(expected.size(), counts.size());
        EXPECT_GT(chi_square_test(counts, expected).p_value, sidak_level(1e-4, 3));
    }
}

TEST(Choice, TakesWhatIsNotFinite) {
    for (const double odd : {std::nan(""), std::numeric_limits<double>::infinity()})
        for (int place = 0; place < 3; ++place) {
            Choice<double> choice{.rest = 0.999};
            bool taken = false;
            for (int k = 0; k < 3; ++k) {
                const bool takes = choice.offer(k == place ? odd : 1.0);
                if (k == place) taken = takes;
            }
            EXPECT_TRUE(taken) << odd << " at " << place;
            EXPECT_FALSE(std::isfinite(choice.factor()));
        }
}

void expect_same_bits(double a, double b) {
    if (std::isnan(a) && std::isnan(b)) return;
    ASSERT_EQ(a, b);
}

// Eight choices side by side are those of each alone, whatever the others' candidates: of no
// importance, over many decades, and some that are no numbers.
TEST(Choice, OfEightIsThatOfEachAlone) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> uniform;
    for (int round = 0; round < 200; ++round) {
        Choice<Double8> eight;
        std::array<Choice<double>, lane_count> alone;
        for (int k = 0; k < lane_count; ++k)
            eight.rest.set(k, alone[k].rest = k == 0 ? 0 : uniform(random));
        for (int i = 0; i < 20; ++i) {
            Double8 importance{};
            for (int k = 0; k < lane_count; ++k)
                if (uniform(random) < 0.7)
                    importance.set(k, std::pow(10.0, 16 * uniform(random) - 8));
            if (round % 10 == 0 && i == 7)
                importance.set(3, std::numeric_limits<double>::infinity());
            if (round % 10 == 1 && i == 7) importance.set(4, std::nan(""));
            const Mask8 takes = eight.offer(importance);
            for (int k = 0; k < lane_count; ++k) {
                ASSERT_EQ(takes[k] != 0, alone[k].offer(importance[k]));
                expect_same_bits(eight.rest[k], alone[k].rest);
                expect_same_bits(eight.factor()[k], alone[k].factor());
            }
        }
    }
}

}  // namespace
}  // namespace midway::test
