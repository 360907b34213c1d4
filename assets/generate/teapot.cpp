#include <algorithm>
#include <cmath>

#include "figures.h"
#include "implicit.h"

namespace midway::assets {
namespace {

double pot(const dvec3& p) {
    double d = ellipsoid(p - dvec3(0, 0.38, 0), {0.50, 0.40, 0.50});
    d = joined(d, std::max(std::hypot(p.x, p.z) - 0.30, std::abs(p.y - 0.06) - 0.06) - 0.03, 0.10);
    const double lid_line = std::hypot(d, p.y - 0.66);  // a groove where the lid meets the pot
    d = carved(d, lid_line - 0.03, 0.06);
    return joined(d, glm::length(p - dvec3(0, 0.84, 0)) - 0.075, 0.10);
}

double spout(const dvec3& p) {
    const double d = capsule(p, {0.34, 0.26, 0}, {0.64, 0.42, 0}, 0.13, 0.085);
    return joined(d, capsule(p, {0.64, 0.42, 0}, {0.82, 0.72, 0}, 0.085, 0.075), 0.10);
}

double handle(const dvec3& p) {
    const dvec3 q = p - dvec3(-0.50, 0.42, 0);
    const double ring = std::hypot(q.x / 1.1, q.y) - 0.22;
    return std::hypot(ring, q.z) - 0.05;
}

double teapot_field(const dvec3& p) {
    const double d = joined(joined(pot(p), handle(p), 0.06), spout(p), 0.12);
    const double mouth = glm::length(p - dvec3(0.855, 0.80, 0)) - 0.05;
    return intersected(carved(d, mouth, 0.05), -p.y, 0.06);
}

}  // namespace

Mesh teapot(double cell) {
    return polygonise(teapot_field,
                      {.low = {-0.95, -0.15, -0.65}, .high = {1.05, 1.05, 0.65}, .cell = cell});
}

}  // namespace midway::assets
