// The recursion of the MIS weights run in float beside double, given the same pdfs: where would
// float have failed? Errors are taken against the direct form in long double, and sorted by the
// range of the path's densities: log10 of the largest over the smallest density per area of its
// vertices, from both ends.
#pragma once

#include "report/audit_sums.h"
#include "report/whole_path_recursion.h"

namespace midway {

// Paths of one exponent whose range lies in [decades, decades + float_range_step).
struct FloatRecursionCell {
    Deviation in_float, in_double;  // worst over the strategies of |recursive - direct|
    std::uint64_t lost = 0;         // paths with a float weight that is not finite
    std::uint64_t spoilt = 0;       // float error above 1e-3, lost ones included
};

inline constexpr int float_range_step = 4, float_range_cells = 25;

struct FloatRecursion {
    std::vector<double> exponents;
    std::vector<FloatRecursionCell> cells;  // exponent by exponent, float_range_cells of each
    FloatRecursionCell& at(size_t exponent, int cell) {
        return cells[exponent * float_range_cells + static_cast<size_t>(cell)];
    }
    const FloatRecursionCell& at(size_t exponent, int cell) const {
        return cells[exponent * float_range_cells + static_cast<size_t>(cell)];
    }
    void merge(const FloatRecursion& other);
};

FloatRecursion make_float_recursion(const std::vector<double>& exponents);

// Adds one path of at least two edges; `direct` are the direct weights and `in_double` the
// recursive ones of the exponent.
struct WeighedPath {
    const PathPdfs* pdfs = nullptr;
    const std::vector<double>*direct = nullptr, *in_double = nullptr;
    AuditPlace place;
};
void add_path(FloatRecursion& r, size_t exponent, const WeighedPath& path,
              const PathSetting& setting);

double density_range(const PathPdfs& pdfs);  // decades

// Made-up paths whose densities spread evenly over up to so many decades: the same table where no
// scene sets a limit.
struct MadeUpPaths {
    int edges = 11;
    double decades = 40;
    int paths = 20000;
    std::uint64_t seed = 1;
};
FloatRecursion made_up_float_recursion(const MadeUpPaths& paths);

}  // namespace midway
