// Tests of a sampling routine against the density that it claims, on a grid of cells over a square
// or over the sphere. The density is integrated over every cell, and what no sample may be lost to
// (probability that a sample carries nothing, Dirac lobes) is a cell of its own, so that a density
// that does not integrate to what it should fails too.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "math/frame.h"
#include "support/statistics.h"

namespace midway::test {

// Cells over [0, 1)^2, column by column within a row.
struct Grid {
    int columns = 32, rows = 16;
    int cells() const { return columns * rows; }
    int cell(double x, double y) const;
};

using SquareDensity = std::function<double(double x, double y)>;
using SphereDensity = std::function<double(const vec3& direction)>;

// The integral of a density per unit area of the square over every cell. Cells are halved until the
// midpoint rule moves by less than 1e-3 of the cell, or of the mean cell's hundredth.
std::vector<double> integrate_cells(const Grid& grid, const SquareDensity& density);

// Directions by (phi / 2 pi, (1 - z) / 2) about the frame's z: cells of equal solid angle.
dvec2 sphere_to_square(const Frame& frame, const vec3& direction);
vec3 square_to_direction(const Frame& frame, double x, double y);

struct DensityResult {
    ChiSquare test;
    double integral = 0;  // of the density
    double lost = 0;      // observed share of samples that carried nothing
};

// Draws `samples` times; an empty result is lost (or one of a Dirac lobe): the share that the density
// leaves over is expected to be.
DensityResult test_square_density(const Grid& grid, int samples,
                                  const std::function<std::optional<dvec2>()>& draw,
                                  const SquareDensity& density);
DensityResult test_sphere_density(const Frame& frame, const Grid& grid, int samples,
                                  const std::function<std::optional<vec3>()>& draw,
                                  const SphereDensity& pdf_w);

}  // namespace midway::test
