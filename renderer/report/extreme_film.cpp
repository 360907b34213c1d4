// Film: 1e10 additions into one pixel, and sums at the edge of 128 bits.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "render/film_record.h"
#include "report/extreme_groups.h"

namespace midway::extreme {
namespace {

constexpr int unit = -90;

// Contributions with 4096 mantissas and 25 magnitudes a factor of 8 apart; the two counts share no
// divisor, so a hundred rounds of 102,400 hold every pair a hundred times.
constexpr std::int64_t mantissas = 4096, magnitudes = 25, rounds = 100, doublings = 10;
float contribution(std::int64_t i) {
    return std::ldexp(1 + float(i % mantissas) / mantissas, -3 * static_cast<int>(i % magnitudes));
}

// 1.05e10 additions: 1.024e7 of them one by one, then ten times the film joined with itself.
CaseResult ten_billion_additions(const CaseContext&) {
    Film film(1, 1, unit);
    FixedCounts counts;
    float naive = 0;
    bool fits = true;
    for (std::int64_t i = 0; i < rounds * mantissas * magnitudes; ++i) {
        const float v = contribution(i);
        const Int128 fixed = to_fixed(v, unit, counts);
        fits &= film.add(0, 0, 0, {fixed, fixed, fixed});
        naive += v;
    }
    for (int k = 0; k < doublings; ++k) {
        const Film copy = film;
        film.merge(copy);
        naive += naive;
    }
    const long double one_round = (mantissas + (mantissas - 1) / 2.0L) *
                                  (1 - std::ldexp(1.0L, -3 * int(magnitudes))) / (1 - 0.125L);
    const long double expected = std::ldexp(rounds * one_round, doublings);
    const double sum = from_fixed(film.sum(0, 0, 0)[1], unit);
    const double error = static_cast<double>(std::abs(sum / expected - 1));
    CaseResult r;
    r.measured = fmt::format("relative error {:.1e}", error);
    r.bar = "< 1e-9";
    r.passed = error < 1e-9 && fits && counts.overflow == 0 && counts.inexact == 0;
    r.detail = fmt::format("a float sum is off by {:.1e}",
                           static_cast<double>(std::abs(naive / expected - 1)));
    return r;
}

// How many of the tries at the edge of the range were counted as they must be.
struct Edge {
    int tries = 0, right = 0;
    void expect(bool yes) {
        ++tries;
        right += yes;
    }
};

void sums_at_the_edge(Edge& e) {
    constexpr Int128 largest = static_cast<Int128>(~UInt128{0} >> 1);
    for (const int sign : {1, -1}) {
        const Int128 most = sign > 0 ? largest : -largest - 1;
        for (int channel = 0; channel < 3; ++channel) {
            Film film(1, 1, unit);
            FixedRgb start{}, step{};
            start[channel] = most - sign;
            step[channel] = sign;
            e.expect(film.add(0, 0, 0, start));
            e.expect(film.add(0, 0, 0, step));
            e.expect(film.sum(0, 0, 0)[channel] == most);
            e.expect(!film.add(0, 0, 0, step));
        }
    }
}

// What a record counts for two equal contributions to one sample.
std::uint64_t counted(float value, bool splat) {
    std::vector<Film> films;
    films.emplace_back(1, 1, unit);
    FilmTargets targets;
    targets.films = &films;
    targets.crop = {0, 0, 1, 1};
    WorkerSums sums;
    FilmRecord<false> record(targets, sums);
    Contribution c;
    c.strategy = {2, 1};
    c.value = vec3(value);
    c.weights.fill(1);
    record.begin(0, 0, 0);
    for (int k = 0; k < 2; ++k)
        if (splat)
            record.splat(0, 0, c);
        else
            record.contribution(c);
    record.end();
    return sums.fixed.overflow + sums.nonfinite.count;
}

CaseResult no_silent_overflow(const CaseContext&) {
    Edge e;
    sums_at_the_edge(e);
    // Two of 2^29 units of the scene's power fit; 2^31 is refused, as are the largest floats.
    for (const bool splat : {false, true}) {
        e.expect(counted(0x1p29f, splat) == 0);
        e.expect(counted(0x1p31f, splat) > 0);
        e.expect(counted(std::numeric_limits<float>::max(), splat) > 0);
        e.expect(counted(std::numeric_limits<float>::infinity(), splat) > 0);
        e.expect(counted(std::numeric_limits<float>::quiet_NaN(), splat) > 0);
    }
    CaseResult r;
    r.passed = e.right == e.tries;
    r.measured = fmt::format("{} of {} edges as they must be", e.right, e.tries);
    r.bar = "all";
    return r;
}

}  // namespace

std::vector<ExtremeCase> film_cases() {
    return {{"film", "ten_billion_additions",
             "1e10 additions over 22 decades into one pixel give the sum of the series", true,
             ten_billion_additions},
            {"film", "no_silent_overflow", "what leaves 128 bits, or is not a number, is counted",
             true, no_silent_overflow}};
}

}  // namespace midway::extreme
