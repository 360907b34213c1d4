#include "report/float_recursion.h"

#include <algorithm>
#include <cmath>

#include "math/hash.h"

namespace midway {
namespace {

constexpr double spoilt_weight = 1e-3;

double worst_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double d = std::abs(a[i] - b[i]);
        if (!(d <= worst)) worst = std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
    }
    return worst;
}

// A path of the given number of edges with densities up to `decades` apart; a quarter of its inner
// vertices are smooth.
PathPdfs make_up_path(int edges, double decades, std::uint64_t seed) {
    std::uint64_t state = seed;
    const auto unit = [&] { return static_cast<double>((state = mix64(state)) >> 11) * 0x1p-53; };
    const auto number = [&] { return std::pow(10.0, (unit() - 0.5) * decades); };
    PathPdfs p;
    p.vertices.resize(static_cast<size_t>(edges) + 1);
    for (int i = 0; i <= edges; ++i) {
        VertexPdfs& v = p.vertices[i];
        v = {number(), 1, number(), 1};
        v.delta = i > 0 && i < edges && unit() < 0.25;
    }
    p.emission = number();
    p.next_event = number();
    return p;
}

}  // namespace

FloatRecursion make_float_recursion(const std::vector<double>& exponents) {
    FloatRecursion r;
    r.exponents = exponents;
    r.cells.resize(exponents.size() * float_range_cells);
    return r;
}

void FloatRecursion::merge(const FloatRecursion& o) {
    for (size_t i = 0; i < cells.size(); ++i) {
        cells[i].in_float.merge(o.cells[i].in_float);
        cells[i].in_double.merge(o.cells[i].in_double);
        cells[i].lost += o.cells[i].lost;
        cells[i].spoilt += o.cells[i].spoilt;
    }
}

double density_range(const PathPdfs& p) {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (int i = 1; i < p.edges(); ++i)
        for (const double density : {p.from_camera(i), p.from_light(i)}) {
            if (!(density > 0)) continue;
            low = std::min(low, density);
            high = std::max(high, density);
        }
    return high > 0 ? std::log10(high / low) : 0;
}

void add_path(FloatRecursion& r, size_t exponent, const WeighedPath& path,
              const PathSetting& setting) {
    const double range = density_range(*path.pdfs);
    const int cell =
        std::clamp(static_cast<int>(range / float_range_step), 0, float_range_cells - 1);
    FloatRecursionCell& c = r.at(exponent, cell);
    const std::vector<double> in_float =
        recursive_weights_in_float(*path.pdfs, setting, r.exponents[exponent]);
    const double error = worst_difference(in_float, *path.direct);
    c.in_float.add(error, path.place);
    c.in_double.add(worst_difference(*path.in_double, *path.direct), path.place);
    c.lost += std::isinf(error);
    c.spoilt += !(error <= spoilt_weight);
}

FloatRecursion made_up_float_recursion(const MadeUpPaths& m) {
    FloatRecursion r = make_float_recursion({0, 0.1, 0.5, 1, 2, 8, 32});
    const PathSetting setting;
    for (int i = 0; i < m.paths; ++i) {
        // Every range up to the widest gets its share of the paths.
        const double decades = m.decades * (i + 1) / m.paths;
        const PathPdfs p =
            make_up_path(m.edges, decades, hash_combine(m.seed, static_cast<std::uint64_t>(i)));
        const std::vector<long double> logs = log_densities(p, setting);
        for (size_t b = 0; b < r.exponents.size(); ++b) {
            const std::vector<double> direct = direct_weights(logs, r.exponents[b]);
            const std::vector<double> recursive = recursive_weights(p, p, setting, r.exponents[b]);
            add_path(r, b, {&p, &direct, &recursive, {}}, setting);
        }
    }
    return r;
}

}  // namespace midway
