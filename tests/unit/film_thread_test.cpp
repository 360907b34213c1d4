// The film's sums: exact, and the same for every order, thread and split.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <latch>
#include <thread>

#include "image/film.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

using FilmSums = WorkerMode;

struct Splash {
    int half, x, y;
    vec3 value;
};

// Values of both signs over 20 decades, so that low words carry and borrow.
std::vector<Splash> splashes(int n) {
    Random random(1);
    std::vector<Splash> list;
    for (int i = 0; i < n; ++i) {
        const auto value = [&] {
            const float sign = random.next() < 0.4f ? -1.0f : 1.0f;
            return sign * std::pow(10.0f, 20 * random.next() - 12) * (1 + random.next());
        };
        list.push_back({int(random.below(2)),
                        int(random.below(3)),
                        int(random.below(2)),
                        {value(), value(), value()}});
    }
    return list;
}

void add(Film& film, const Splash& s) {
    FixedCounts counts;
    const int unit = film.unit_exponent();
    EXPECT_TRUE(film.add(s.half, s.x, s.y,
                         {to_fixed(s.value.x, unit, counts), to_fixed(s.value.y, unit, counts),
                          to_fixed(s.value.z, unit, counts)}));
}

Film straight_through(const std::vector<Splash>& list) {
    Film film(3, 2, -90);
    for (const Splash& s : list) add(film, s);
    return film;
}

TEST_F(FilmSums, DoNotDependOnTheOrder) {
    std::vector<Splash> list = splashes(20000);
    const Film reference = straight_through(list);
    std::mt19937_64 engine(test_seed(2));
    for (int k = 0; k < 5; ++k) {
        std::shuffle(list.begin(), list.end(), engine);
        EXPECT_EQ(straight_through(list).words(), reference.words());
    }
}

TEST_F(FilmSums, DoNotDependOnTheThreads) {
    const std::vector<Splash> list = splashes(20000);
    const Film reference = straight_through(list);
    for (const size_t threads : {2u, 5u}) {
        Film film(3, 2, -90);
        {
            std::vector<std::jthread> workers;
            for (size_t t = 0; t < threads; ++t)
                workers.emplace_back([&, t] {
                    for (size_t i = t; i < list.size(); i += threads) add(film, list[i]);
                });
        }
        EXPECT_EQ(film.words(), reference.words());
    }
}

TEST_F(FilmSums, LoseNothingWhereManyAddAtOnce) {
    constexpr int threads = 4, times = 1'000'000;
    Film film(1, 1, -90);
    const Int128 value = (Int128(3) << 63) + 1;  // the low word carries all the time
    {
        std::latch all(threads);
        std::vector<std::jthread> workers;
        for (int t = 0; t < threads; ++t)
            workers.emplace_back([&] {
                all.arrive_and_wait();
                for (int i = 0; i < times; ++i)
                    if (!film.add(0, 0, 0, {value, -value, 1})) return;
            });
    }
    const Int128 n = threads * times;
    EXPECT_EQ(film.sum(0, 0, 0), (FixedRgb{n * value, -n * value, n}));
}

TEST_F(FilmSums, MergedAreThoseStraightThrough) {
    const std::vector<Splash> list = splashes(5000);
    const std::vector<Splash> first(list.begin(), list.begin() + 1234);
    const std::vector<Splash> second(list.begin() + 1234, list.end());
    Film merged = straight_through(second);
    merged.merge(straight_through(first));
    EXPECT_EQ(merged.words(), straight_through(list).words());
    EXPECT_THROW(merged.merge(Film(2, 2, -90)), std::runtime_error);
    EXPECT_THROW(merged.merge(Film(3, 2, -91)), std::runtime_error);
}

// Sums of what cancels leave the small part to the last bit; floats would have lost it.
TEST_F(FilmSums, AreExactAcrossThirtyDecades) {
    Film film(1, 1, -90);
    for (const float v : {1e9f, 0x1p-80f, -1e9f, 3.0f, 0x1p-90f, -3.0f})
        add(film, {0, 0, 0, vec3(v)});
    EXPECT_EQ(film.sum(0, 0, 0)[0], (Int128(1) << 10) + 1);
    add(film, {0, 0, 0, vec3(-0x1p-79f)});
    EXPECT_EQ(film.sum(0, 0, 0)[1], 1 - (Int128(1) << 10));
    EXPECT_DOUBLE_EQ(from_fixed(film.sum(0, 0, 0)[2], -90), 0x1p-90 - 0x1p-80);
    EXPECT_EQ(film.sum(1, 0, 0)[0], 0);
}

TEST_F(FilmSums, CarryFromTheLowWordToTheHigh) {
    Film film(1, 1, -90);
    const Int128 low = (Int128(1) << 64) - 1;
    EXPECT_TRUE(film.add(0, 0, 0, {low, -1, 0}));
    EXPECT_TRUE(film.add(0, 0, 0, {1, 1, 0}));
    EXPECT_EQ(film.sum(0, 0, 0)[0], Int128(1) << 64);
    EXPECT_EQ(film.sum(0, 0, 0)[1], 0);
    EXPECT_TRUE(film.add(0, 0, 0, {-(Int128(1) << 65), 0, 0}));
    EXPECT_EQ(film.sum(0, 0, 0)[0], -(Int128(1) << 64));
}

TEST_F(FilmSums, SayWhenASumLeavesTheirRange) {
    Film film(1, 1, -90);
    const Int128 large = Int128(1) << 126;
    EXPECT_TRUE(film.add(0, 0, 0, {large, -large, 0}));
    EXPECT_FALSE(film.add(0, 0, 0, {large, 0, 0}));
    EXPECT_TRUE(film.add(0, 0, 0, {0, -large, 0}));
    EXPECT_FALSE(film.add(0, 0, 0, {0, -1, 0}));
}

TEST_F(FilmSums, RoundToNearestBelowTheUnitAndSaySo) {
    const auto fixed = [](float v, std::uint64_t inexact) {
        FixedCounts counts;
        const Int128 f = to_fixed(v, 0, counts);
        EXPECT_EQ(counts.inexact, inexact) << v;
        EXPECT_EQ(counts.overflow, 0u) << v;
        return static_cast<long long>(f);
    };
    EXPECT_EQ(fixed(0.0f, 0), 0);
    EXPECT_EQ(fixed(-0.0f, 0), 0);
    EXPECT_EQ(fixed(1.0f, 0), 1);
    EXPECT_EQ(fixed(-7.0f, 0), -7);
    EXPECT_EQ(fixed(16777215.0f, 0), 16777215);
    EXPECT_EQ(fixed(0x1p60f, 0), 1ll << 60);
    EXPECT_EQ(fixed(2.25f, 1), 2);
    EXPECT_EQ(fixed(2.75f, 1), 3);
    EXPECT_EQ(fixed(-2.75f, 1), -3);
    EXPECT_EQ(fixed(0.51f, 1), 1);
    EXPECT_EQ(fixed(0.49f, 1), 0);
    EXPECT_EQ(fixed(1e-20f, 1), 0);
}

TEST_F(FilmSums, CountWhatDoesNotFit) {
    FixedCounts counts;
    EXPECT_EQ(to_fixed(std::numeric_limits<float>::max(), -90, counts), 0);
    EXPECT_EQ(counts.overflow, 1u);
    EXPECT_NE(to_fixed(1e9f, -90, counts), 0);
    EXPECT_EQ(counts.overflow, 1u);
    EXPECT_EQ(counts.inexact, 0u);
}

TEST_F(FilmSums, UnitFollowsThePower) {
    EXPECT_EQ(film_unit_exponent(0), -90);
    EXPECT_EQ(film_unit_exponent(0.75), -90);
    EXPECT_EQ(film_unit_exponent(1000), 10 - 90);
    EXPECT_EQ(film_unit_exponent(std::nan("")), -90);
}

TEST_F(FilmSums, ResolveToTheMeanOfAllPasses) {
    Film film(1, 1, -90);
    add(film, {0, 0, 0, {3, 1, 0}});
    add(film, {1, 0, 0, {1, 0, 0}});
    add(film, {0, 0, 0, {2, 1, 0}});
    const PassCounts passes = pass_counts(0, 3);
    EXPECT_EQ(passes.a, 2u);
    EXPECT_EQ(passes.b, 1u);
    EXPECT_EQ(resolve(film, passes).at(0, 0), vec3(2, 2.0f / 3, 0));
    // Halves' means (2.5, 1, 0) and (1, 0, 0).
    EXPECT_EQ(resolve_variance(film, passes).at(0, 0), vec3(0.5625f, 0.25f, 0));
    EXPECT_EQ(resolve_variance(film, {2, 0}).at(0, 0), vec3(0));
}

// Mean of the estimated variance over many films is the variance of the mean: 4 in 100 is five
// standard errors (a squared normal spreads by sqrt(2 / n)).
TEST_F(FilmSums, VarianceIsThatOfTheMean) {
    Random random(3);
    constexpr int pixels = 8000, passes = 16;
    Film film(pixels, 1, -90);
    for (int x = 0; x < pixels; ++x)
        for (int p = 0; p < passes; ++p) add(film, {p & 1, x, 0, vec3(random.next())});
    const Image variance = resolve_variance(film, pass_counts(0, passes));
    double sum = 0;
    for (const vec3& v : variance.pixels) sum += v.x;
    EXPECT_NEAR(sum / pixels / (1.0 / 12 / passes), 1, 0.08);
}

TEST_F(FilmSums, PassCountsAddUp) {
    for (std::uint64_t first = 0; first < 5; ++first)
        for (std::uint64_t end = first; end < 9; ++end) {
            const PassCounts n = pass_counts(first, end);
            EXPECT_EQ(n.total(), end - first);
            std::uint64_t even = 0;
            for (std::uint64_t p = first; p < end; ++p) even += p % 2 == 0;
            EXPECT_EQ(n.a, even);
        }
}

}  // namespace
}  // namespace midway::test
