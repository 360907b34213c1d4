#include "support/density.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace midway::test {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

double midpoints(const SquareDensity& density, double x0, double y0, double width, double height,
                 int n) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            sum += density(x0 + width * (i + 0.5) / n, y0 + height * (j + 0.5) / n);
    return sum / (n * n) * width * height;
}

}  // namespace

int Grid::cell(double x, double y) const {
    const int column = std::clamp(static_cast<int>(x * columns), 0, columns - 1);
    const int row = std::clamp(static_cast<int>(y * rows), 0, rows - 1);
    return row * columns + column;
}

std::vector<double> integrate_cells(const Grid& grid, const SquareDensity& density) {
    constexpr int finest = 128;
    std::vector<double> integrals;
    const double width = 1.0 / grid.columns, height = 1.0 / grid.rows;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const auto rule = [&](int n) {
                return midpoints(density, column * width, row * height, width, height, n);
            };
            double coarse = rule(4), fine = rule(8);
            for (int n = 16; n <= finest; n *= 2) {
                // A support may end in a sliver of the cell, so zero is not taken for an answer.
                const bool settled =
                    std::abs(fine - coarse) < 1e-3 * std::max(fine, 0.01 / grid.cells());
                if (settled && (fine > 0 || n > 16)) break;
                coarse = fine;
                fine = rule(n);
            }
            integrals.push_back(fine);
        }
    return integrals;
}

dvec2 sphere_to_square(const Frame& frame, const vec3& direction) {
    const vec3 l = frame.to_local(direction);
    const double phi = std::atan2(double(l.y), double(l.x)) / two_pi;
    return {phi < 0 ? phi + 1 : phi, 0.5 * (1 - double(l.z))};
}

vec3 square_to_direction(const Frame& frame, double x, double y) {
    const double z = 1 - 2 * y, r = std::sqrt(std::max(0.0, 1 - z * z));
    return frame.to_world(vec3(dvec3(r * std::cos(two_pi * x), r * std::sin(two_pi * x), z)));
}

DensityResult test_square_density(const Grid& grid, int samples,
                                  const std::function<std::optional<dvec2>()>& draw,
                                  const SquareDensity& density) {
    DensityResult result;
    std::vector<double> expected = integrate_cells(grid, density);
    for (double& e : expected) {
        result.integral += e;
        e *= samples;
    }
    std::vector<double> observed(expected.size() + 1, 0.0);
    for (int i = 0; i < samples; ++i) {
        const std::optional<dvec2> p = draw();
        ++observed[p ? grid.cell(p->x, p->y) : grid.cells()];
    }
    result.lost = observed.back() / samples;
    if (result.integral == 0) {
        result.test.p_value = result.lost == 1 ? 1 : 0;
        return result;
    }
    // Rounding of the integral alone expects nothing to be lost.
    const double lost = 1 - result.integral;
    if (lost < 1e-3 && observed.back() == 0)
        observed.pop_back();
    else
        expected.push_back(std::max(0.0, lost) * samples);
    result.test = chi_square_test(observed, expected);
    return result;
}

DensityResult test_sphere_density(const Frame& frame, const Grid& grid, int samples,
                                  const std::function<std::optional<vec3>()>& draw,
                                  const SphereDensity& pdf_w) {
    const auto place = [&]() -> std::optional<dvec2> {
        const std::optional<vec3> d = draw();
        if (!d) return {};
        return sphere_to_square(frame, *d);
    };
    return test_square_density(grid, samples, place, [&](double x, double y) {
        return 2 * two_pi * pdf_w(square_to_direction(frame, x, y));
    });
}

}  // namespace midway::test
