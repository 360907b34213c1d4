#include "math/distribution.h"

#include <algorithm>

namespace midway {

Distribution1D make_distribution(const std::vector<double>& weights) {
    Distribution1D d;
    d.cdf.resize(weights.size() + 1, 0.0);
    double sum = 0;
    for (size_t i = 0; i < weights.size(); ++i) d.cdf[i + 1] = sum += weights[i];
    d.total = sum;
    if (!(sum > 0)) return d;
    for (double& c : d.cdf) c /= sum;
    d.guide.reserve(weights.size());
    std::uint32_t interval = 0;
    for (size_t part = 0; part < weights.size(); ++part) {
        while (interval + 1 < weights.size() &&
               d.cdf[interval + 1] <= double(part) / double(weights.size()))
            ++interval;
        d.guide.push_back(interval);
    }
    return d;
}

int find_interval(const Distribution1D& d, double u) {
    // The first boundary above u ends the interval; an empty interval has no point that is above
    // its start and below its end, so it is never chosen. Rounding at the top end falls back to the
    // last interval that is not empty.
    const int last = d.size() - 1;
    int i = static_cast<int>(d.guide[std::min(static_cast<int>(u * d.size()), last)]);
    while (i > 0 && d.cdf[i] > u) --i;
    while (i < last && d.cdf[i + 1] <= u) ++i;
    while (d.cdf[i + 1] == d.cdf[i]) --i;
    return i;
}

DiscreteSample sample_discrete(const Distribution1D& d, double u) {
    const int i = find_interval(d, u);
    const double p = d.probability(i);
    const double inside = (u - d.cdf[i]) / p;
    return {i, p, std::clamp(static_cast<float>(inside), 0.0f, 1 - 0x1p-24f)};
}

Distribution2D make_distribution_2d(const std::vector<double>& weights, int width, int height) {
    Distribution2D d;
    d.width = width;
    d.height = height;
    std::vector<double> row_weights;
    for (int y = 0; y < height; ++y) {
        const auto first = weights.begin() + static_cast<std::ptrdiff_t>(y) * width;
        d.columns.push_back(make_distribution(std::vector<double>(first, first + width)));
        row_weights.push_back(d.columns.back().total);
    }
    d.rows = make_distribution(row_weights);
    return d;
}

CellSample sample_cell(const Distribution2D& d, const vec2& u) {
    const DiscreteSample row = sample_discrete(d.rows, u.y);
    const DiscreteSample column = sample_discrete(d.columns[row.index], u.x);
    return {column.index,
            row.index,
            row.probability * column.probability,
            {column.remapped, row.remapped}};
}

double cell_probability(const Distribution2D& d, int x, int y) {
    return d.rows.probability(y) * (d.columns[y].total > 0 ? d.columns[y].probability(x) : 0.0);
}

}  // namespace midway
