// What the audit gathers: counts and extremes that do not depend on the order of adding, so that
// workers' sums can be merged in any order with the same result.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "integrator/strategy.h"

namespace midway {

// A path by the sample that draws it, and the vertex at fault (0 is the lens; -1: none).
struct AuditPlace {
    int x = 0, y = 0;
    std::uint64_t pass = 0;
    Strategy strategy;
    int vertex = -1;
    auto key() const { return std::tie(y, x, pass, strategy.s, strategy.t, vertex); }
};

// Absolute deviations: a histogram over their logarithm, and the worst with its place. A deviation
// that is not a number counts as infinite.
class Deviation {
  public:
    void add(double deviation, const AuditPlace& place);
    void merge(const Deviation& other);

    std::uint64_t count() const { return count_; }
    double worst() const { return worst_; }
    const AuditPlace& place() const { return place_; }
    // The deviation that the share q of all does not exceed, rounded up to the next of 20 steps per
    // decade; 0 where there are none.
    double quantile(double q) const;

  private:
    static constexpr int steps = 20, lowest = -20, decades = 24;
    std::array<std::uint64_t, steps * decades + 2> bins_{};  // zeros and below first, infinity last
    std::uint64_t count_ = 0;
    double worst_ = 0;
    AuditPlace place_;
};

// Logarithms (base 10) of the smallest and largest positive value seen.
struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    bool empty() const { return !(low <= high); }
    void add_log(double decades);
    void add(double value);
    void merge(const Range& other);
};

}  // namespace midway
