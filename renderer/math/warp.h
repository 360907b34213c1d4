// Warps from the unit square to the shapes that are sampled, each beside its density. Random
// numbers lie in [0, 1 - 2^-24]; every warp gives a finite result of non-zero density for all of
// them.
#pragma once

#include "math/frame.h"
#include "math/lanes.h"
#include "math/vector.h"

namespace midway {

// Uniform on the unit disc, area-preserving and continuous (Shirley & Chiu 1997). Half of all
// points lie in its wide sectors, by chance: choices in place of branches, which nobody could
// foresee. Sine and cosine of up to an eighth of a turn are polynomials through the Chebyshev
// points in the square of the ratio, within 2.5e-9.
template <class F>
struct DiscPoint {
    F x, y;
};
template <class F>
DiscPoint<F> square_to_disc(const F& u, const F& v) {
    const F a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
    const auto wide = abs(a) > abs(b);
    const F r = select(wide, a, b), other = select(wide, b, a);
    const F ratio = select(r != 0, other / r, F{}), y = ratio * ratio;
    const F sine =
        ratio * (0.785398161f + y * (-0.0807454347f + y * (0.0024900068f - y * 3.59542907e-05f)));
    const F cosine =
        1.0f +
        y * (-0.308425135f + y * (0.0158543252f + y * (-0.000325938586f + y * 3.52979722e-06f)));
    return {r * select(wide, cosine, sine), r * select(wide, sine, cosine)};
}
inline vec2 square_to_disc(const vec2& u) {
    const DiscPoint<float> d = square_to_disc(u.x, u.y);
    return {d.x, d.y};
}

// Cosine-weighted about +z (Malley's method); z is kept above zero so that the density is too.
inline constexpr float least_squared_cosine = 1e-12f;
inline Vec3x8 square_to_cosine_hemisphere(const Float8& u, const Float8& v) {
    const DiscPoint<Float8> d = square_to_disc(u, v);
    return {d.x, d.y, sqrt(max(all_lanes(least_squared_cosine), 1.0f - d.x * d.x - d.y * d.y))};
}
inline vec3 square_to_cosine_hemisphere(const vec2& u) {
    const vec2 d = square_to_disc(u);
    return {d.x, d.y, std::sqrt(std::max(least_squared_cosine, 1 - d.x * d.x - d.y * d.y))};
}
inline float cosine_hemisphere_pdf_w(float cos_theta) { return cos_theta * inv_pi; }

// Direction at height z with azimuth 2 pi u.
inline vec3 direction_from_z(float z, float u) {
    const float r = safe_sqrt((1 - z) * (1 + z));
    const float phi = 2 * pi * u;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

inline vec3 square_to_sphere(const vec2& u) { return direction_from_z(1 - 2 * u.x, u.y); }
inline constexpr float sphere_pdf_w = 0.25f * inv_pi;

// Barycentric coordinates of vertices 1 and 2, uniform on the triangle, without the crease of the
// square root (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
template <class F>
struct TrianglePlace {
    F b1, b2;
};
template <class F>
TrianglePlace<F> square_to_triangle(const F& u, const F& v) {
    const auto above = v > u;
    const F less = 0.5f * select(above, u, v), more = select(above, v, u) - less;
    return {select(above, less, more), select(above, more, less)};
}
inline vec2 square_to_triangle(const vec2& u) {
    const TrianglePlace<float> p = square_to_triangle(u.x, u.y);
    return {p.b1, p.b2};
}

}  // namespace midway
