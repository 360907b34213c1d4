#include "shading/albedo_table.h"

#include <array>

#include "shading/microfacet.h"

namespace midway {
namespace {

constexpr int cosines = 32, roughnesses = 16, strata = 24;

struct AlbedoTable {
    std::array<std::array<SchlickAlbedo, cosines>, roughnesses> directional;
    std::array<SchlickAlbedo, roughnesses> average;
};

// Means over visible normals, of which the lobe's weight is F * G2 / G1.
SchlickAlbedo integrate(float mu, float alpha) {
    const vec3 o(safe_sqrt(1 - mu * mu), 0, mu);
    double a = 0, b = 0;
    for (int i = 0; i < strata; ++i)
        for (int j = 0; j < strata; ++j) {
            const vec2 u((i + 0.5f) / strata, (j + 0.5f) / strata);
            const vec3 h = sample_ggx_visible(o, alpha, u);
            const float cos_h = glm::dot(o, h);
            const vec3 in = 2 * cos_h * h - o;
            if (in.z <= 0) continue;
            const float weight = ggx_g2(o, in, alpha) / ggx_g1(o, alpha);
            const float s = schlick_weight(cos_h);
            a += weight * (1 - s);
            b += weight * s;
        }
    constexpr double n = strata * strata;
    return {static_cast<float>(a / n), static_cast<float>(b / n)};
}

// 2 * integral of the piecewise linear E(mu) * mu.
SchlickAlbedo integrate_average(const std::array<SchlickAlbedo, cosines>& row) {
    double a = 0, b = 0;
    const double h = 1.0 / (cosines - 1);
    for (int i = 0; i + 1 < cosines; ++i) {
        const double m0 = i * h, m1 = m0 + h;
        const double w0 = h * (2 * m0 + m1) / 3, w1 = h * (m0 + 2 * m1) / 3;
        a += w0 * row[i].a + w1 * row[i + 1].a;
        b += w0 * row[i].b + w1 * row[i + 1].b;
    }
    return {static_cast<float>(a), static_cast<float>(b)};
}

float row_alpha(int row) { return std::max(smooth_alpha, sqr(row / float(roughnesses - 1))); }

const AlbedoTable& table() {
    static const AlbedoTable t = [] {
        AlbedoTable built;
        for (int r = 0; r < roughnesses; ++r) {
            for (int m = 0; m < cosines; ++m)
                built.directional[r][m] =
                    integrate(std::max(1e-3f, m / float(cosines - 1)), row_alpha(r));
            built.average[r] = integrate_average(built.directional[r]);
        }
        return built;
    }();
    return t;
}

struct Place {
    int index;
    float fraction;
};

Place locate(float x, int n) {
    const float scaled = std::clamp(x, 0.0f, 1.0f) * (n - 1);
    const int i = std::min(static_cast<int>(scaled), n - 2);
    return {i, scaled - i};
}

SchlickAlbedo lerp(const SchlickAlbedo& x, const SchlickAlbedo& y, float t) {
    return {x.a + (y.a - x.a) * t, x.b + (y.b - x.b) * t};
}

}  // namespace

SchlickAlbedo directional_albedo(float mu, float alpha) {
    if (alpha < smooth_alpha) {
        const float s = schlick_weight(mu);
        return {1 - s, s};
    }
    const Place r = locate(std::sqrt(alpha), roughnesses), m = locate(mu, cosines);
    const auto& d = table().directional;
    return lerp(lerp(d[r.index][m.index], d[r.index][m.index + 1], m.fraction),
                lerp(d[r.index + 1][m.index], d[r.index + 1][m.index + 1], m.fraction), r.fraction);
}

SchlickAlbedo average_albedo(float alpha) {
    // The mean of (1 - mu)^5 is 2 * B(2, 6) = 1/21.
    if (alpha < smooth_alpha) return {20.0f / 21, 1.0f / 21};
    const Place r = locate(std::sqrt(alpha), roughnesses);
    return lerp(table().average[r.index], table().average[r.index + 1], r.fraction);
}

}  // namespace midway
