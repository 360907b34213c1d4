#include <algorithm>
#include <cmath>

#include "figures.h"
#include "implicit.h"

namespace midway::assets {
namespace {

constexpr double floor_height = -1.30;  // of the figure's own frame, whose origin is in the skull

double turned_ellipsoid(const dvec3& p, const dvec3& radii, double about_y, double about_z) {
    const double cy = std::cos(about_y), sy = std::sin(about_y);
    const double cz = std::cos(about_z), sz = std::sin(about_z);
    const dvec3 q(cy * p.x - sy * p.z, p.y, sy * p.x + cy * p.z);
    return ellipsoid({cz * q.x - sz * q.y, sz * q.x + cz * q.y, q.z}, radii);
}

double skull(const dvec3& p) {
    double d = ellipsoid(p - dvec3(0, 0.28, -0.18), {0.93, 0.86, 0.92});
    d = joined(d, ellipsoid(p - dvec3(0, 0.02, 0.28), {0.80, 0.66, 0.60}), 0.25);
    d = joined(d, ellipsoid(p - dvec3(0.47, -0.20, 0.54), {0.33, 0.30, 0.30}), 0.20);  // cheek
    // A low crest over the crown.
    d = joined(d, capsule(p, {0, 1.10, 0.10}, {0, 1.15, -0.25}, 0.06, 0.10), 0.35);
    return joined(d, capsule(p, {0, 1.15, -0.25}, {0, 0.80, -0.85}, 0.10, 0.05), 0.35);
}

double muzzle(const dvec3& p) {
    double d = ellipsoid(p - dvec3(0, -0.44, 0.66), {0.52, 0.35, 0.48});
    d = joined(d, ellipsoid(p - dvec3(0.21, -0.38, 0.88), {0.27, 0.23, 0.27}), 0.18);  // lip
    return joined(d, ellipsoid(p - dvec3(0, -0.74, 0.64), {0.36, 0.25, 0.38}), 0.16);  // chin
}

double brow(const dvec3& p) {
    double d = capsule(p, {0.0, 0.36, 0.90}, {0.36, 0.47, 0.86}, 0.13, 0.15);
    d = joined(d, capsule(p, {0.36, 0.47, 0.86}, {0.68, 0.33, 0.60}, 0.15, 0.12), 0.12);
    return joined(d, capsule(p, {0.68, 0.33, 0.60}, {0.75, 0.02, 0.46}, 0.12, 0.08), 0.12);
}

double nose(const dvec3& p) {
    double d = capsule(p, {0, 0.28, 0.86}, {0, -0.06, 0.99}, 0.16, 0.17);
    d = joined(d, ellipsoid(p - dvec3(0, -0.11, 1.10), {0.16, 0.11, 0.11}), 0.10);
    return joined(d, ellipsoid(p - dvec3(0.15, -0.15, 1.05), {0.12, 0.095, 0.11}), 0.10);
}

double ear(const dvec3& p) {
    const dvec3 q = p - dvec3(1.16, 0.12, -0.16);
    double d = turned_ellipsoid(q, {0.44, 0.52, 0.18}, -0.35, 0.15);
    d = carved(d, turned_ellipsoid(q - dvec3(-0.02, 0.0, 0.19), {0.30, 0.37, 0.20}, -0.35, 0.15),
               0.12);
    // The inner fold of the shell.
    d = joined(d, capsule(q, {-0.22, 0.14, 0.10}, {-0.04, -0.18, 0.06}, 0.075, 0.055), 0.12);
    return joined(d, ellipsoid(p - dvec3(0.90, 0.06, -0.14), {0.20, 0.26, 0.15}), 0.14);
}

// Distance to the curve in which a body's surface meets the sheet where `height` is zero.
double surface_line(double body, double height) { return std::hypot(body, height); }

// The mouth runs around the muzzle, corners raised and fading out.
double mouth(const dvec3& p, double body) {
    const double across = p.x / 0.46;
    const double radius =
        0.07 * (1 - across * across * across * across) - 0.4 * std::max(0.66 - p.z, 0.0);
    return surface_line(body, p.y + 0.585 - 0.12 * across * across) - radius;
}

double neck(const dvec3& p) {
    const double y = std::clamp((p.y - floor_height) / 0.9, 0.0, 1.0);
    const double radius = 0.50 + 0.22 * (1 - y) * (1 - y);
    const double side = std::hypot(p.x, p.z + 0.16) - radius;
    return intersected(side * 0.92, std::max(floor_height - p.y, p.y + 0.45), 0.25);
}

double head_field(const dvec3& point) {
    const dvec3 p(std::sqrt(point.x * point.x + 1e-4), point.y, point.z);  // two like halves
    double d = joined(skull(p), neck(p), 0.22);
    d = joined(d, muzzle(p), 0.18);
    d = joined(d, brow(p), 0.12);
    d = carved(d, ellipsoid(p - dvec3(0.36, 0.13, 0.95), {0.26, 0.20, 0.30}), 0.18);
    d = joined(d, nose(p), 0.12);
    d = joined(d, ellipsoid(p - dvec3(0.35, 0.14, 0.66), {0.19, 0.17, 0.18}), 0.10);  // eyeball
    d = carved(d, glm::length(p - dvec3(0.34, 0.13, 0.92)) - 0.10, 0.07);             // pupil
    d = carved(d, ellipsoid(p - dvec3(0.115, -0.22, 1.15), {0.075, 0.065, 0.12}), 0.08);
    d = carved(d, mouth(p, d), 0.20);
    return joined(d, ear(p), 0.14);
}

}  // namespace

Mesh idol_head(double cell) {
    const Mesh head = polygonise(
        head_field, {.low = {-1.75, -1.45, -1.30}, .high = {1.75, 1.40, 1.40}, .cell = cell});
    return transformed(head, translation({0, -floor_height, 0}));
}

}  // namespace midway::assets
