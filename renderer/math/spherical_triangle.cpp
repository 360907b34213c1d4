#include "math/spherical_triangle.h"

#include <algorithm>
#include <cmath>

namespace midway {
namespace {

double sine_of(double cosine) { return std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine))); }

// The part of v at right angles to the unit vector n, as a unit vector.
dvec3 across(const dvec3& v, const dvec3& n) {
    const dvec3 r = v - n * glm::dot(v, n);
    const double l2 = glm::dot(r, r);
    return l2 > 0 ? r / std::sqrt(l2) : dvec3(0);
}

// The vertex c' on the arc from a to c such that (a, b, c') has the area given.
dvec3 cut(const dvec3& a, const dvec3& b, const dvec3& c, double area) {
    const dvec3 to_b = across(b, a), to_c = across(c, a);
    const double cos_alpha = std::clamp(glm::dot(to_b, to_c), -1.0, 1.0);
    const double sin_alpha = glm::length(glm::cross(to_b, to_c));
    const double alpha = std::atan2(sin_alpha, cos_alpha);
    const double s = std::sin(area - alpha), t = std::cos(area - alpha);
    const double u = t - cos_alpha, v = s + sin_alpha * glm::dot(a, b);
    const double below = (v * s + u * t) * sin_alpha;
    const double q = below != 0 ? ((v * t - u * s) * cos_alpha - v) / below : 1;
    const double cosine = std::clamp(q, -1.0, 1.0);
    return a * cosine + to_c * sine_of(cosine);
}

}  // namespace

double solid_angle(const TriangleFrom& t) {
    const dvec3 a = glm::normalize(t.a), b = glm::normalize(t.b), c = glm::normalize(t.c);
    const double above = std::abs(glm::dot(a, glm::cross(b, c)));
    const double below = 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a);
    return 2 * std::atan2(above, below);
}

dvec2 sample_solid_angle(const TriangleFrom& t, double solid_angle, const vec2& u) {
    const dvec3 a = glm::normalize(t.a), b = glm::normalize(t.b), c = glm::normalize(t.c);
    const dvec3 end = cut(a, b, c, u.x * solid_angle);
    const double cosine = 1 - u.y * (1 - glm::dot(end, b));
    const dvec3 d = b * cosine + across(end, b) * sine_of(cosine);
    // The direction in terms of the vertices (Cramer's rule).
    const double weight_a = glm::dot(d, glm::cross(t.b, t.c));
    const double weight_b = glm::dot(d, glm::cross(t.c, t.a));
    const double weight_c = glm::dot(d, glm::cross(t.a, t.b));
    const double sum = weight_a + weight_b + weight_c;
    if (!(std::abs(sum) > 0)) return dvec2(1.0 / 3);
    const double of_b = std::clamp(weight_b / sum, 0.0, 1.0);
    return {of_b, std::clamp(weight_c / sum, 0.0, 1 - of_b)};
}

}  // namespace midway
