// Piecewise-constant distributions in one and two dimensions, by inversion of the cumulative sum so
// that the stratification of the random number survives. Sums are in double.
#pragma once

#include <vector>

#include "math/vector.h"

namespace midway {

// Chooses index i with probability weights[i] / sum. Weights are finite and not negative; where all
// are zero, `total` is zero and nothing can be drawn.
struct Distribution1D {
    std::vector<double> cdf;  // size n + 1, from 0 to 1
    // For each of n equal parts of [0, 1) the interval that its lower end lies in: where a search
    // begins (Chen & Asau 1974), so that it takes a step or two, not log2 n.
    std::vector<std::uint32_t> guide;
    double total = 0;

    int size() const { return static_cast<int>(cdf.size()) - 1; }
    double probability(int i) const { return cdf[i + 1] - cdf[i]; }
    bool operator==(const Distribution1D&) const = default;
};

struct DiscreteSample {
    int index = 0;
    double probability = 0;
    float remapped = 0;  // the place inside the chosen interval, uniform in [0, 1 - 2^-24]
};

Distribution1D make_distribution(const std::vector<double>& weights);

// The index that u in [0, 1) falls to; never one of probability zero.
int find_interval(const Distribution1D& d, double u);

// The same with its probability and the place inside.
DiscreteSample sample_discrete(const Distribution1D& d, double u);

// A grid of `width` x `height` cells: the row first, then the column.
struct Distribution2D {
    int width = 0, height = 0;
    Distribution1D rows;
    std::vector<Distribution1D> columns;  // one a row
};

struct CellSample {
    int x = 0, y = 0;
    double probability = 0;  // of the cell
    vec2 inside{0};          // uniform position in the cell
};

Distribution2D make_distribution_2d(const std::vector<double>& weights, int width, int height);
CellSample sample_cell(const Distribution2D& d, const vec2& u);
double cell_probability(const Distribution2D& d, int x, int y);

}  // namespace midway
