// Warps and discrete distributions against their densities. False-alarm rate of each case: 1e-4,
// shared by its comparisons (sidak_level). Held with 20 other seeds (MIDWAY_TEST_SEED=1..20).
#include "math/warp.h"

#include <gtest/gtest.h>

#include "math/distribution.h"
#include "shading/microfacet.h"
#include "support/density.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

// Density per solid angle of the normals visible from w, w.z > 0 (Heitz 2018, eq. 3).
float ggx_visible_pdf_w(const vec3& w, const vec3& h, float alpha) {
    return ggx_g1(w, alpha) * std::max(0.0f, glm::dot(w, h)) * ggx_d(h, alpha) / w.z;
}

constexpr double alarm = 1e-4;
constexpr int samples = 200'000;
constexpr double two_pi = 6.283185307179586;
constexpr float last = 1 - 0x1p-24f;  // the largest random number

using Warp = WorkerMode;

void expect_follows(const DensityResult& r, double level) {
    EXPECT_GT(r.test.p_value, level)
        << "chi-square " << r.test.statistic << " of " << r.test.degrees_of_freedom;
    EXPECT_EQ(r.test.impossible, 0);
}

// Finds a density that is 3 % wrong over half of the square.
TEST_F(Warp, DiscIsUniform) {
    Random random(1);
    const Grid grid{32, 32};
    const auto draw = [&] {
        const vec2 p = square_to_disc(random.next2());
        return std::optional(dvec2(0.5 + 0.5 * double(p.x), 0.5 + 0.5 * double(p.y)));
    };
    const double density = 4 / 3.14159265358979323846;
    expect_follows(test_square_density(grid, 2 * samples, draw,
                                       [&](double x, double y) {
                                           return sqr(2 * x - 1) + sqr(2 * y - 1) < 1 ? density
                                                                                      : 0.0;
                                       }),
                   alarm);
}

TEST_F(Warp, CosineHemisphereFollowsItsDensity) {
    Random random(2);
    const Frame frame;
    const auto draw = [&] { return std::optional(square_to_cosine_hemisphere(random.next2())); };
    const DensityResult r = test_sphere_density(frame, {32, 64}, samples, draw, [](const vec3& d) {
        return d.z > 0 ? double(cosine_hemisphere_pdf_w(d.z)) : 0.0;
    });
    expect_follows(r, alarm);
    EXPECT_NEAR(r.integral, 1, 1e-4);
}

TEST_F(Warp, SphereIsUniform) {
    Random random(3);
    const auto draw = [&] { return std::optional(square_to_sphere(random.next2())); };
    const DensityResult r =
        test_sphere_density(frame_from_normal(glm::normalize(vec3(1, 2, 3))), {32, 32}, samples,
                            draw, [](const vec3&) { return double(sphere_pdf_w); });
    expect_follows(r, alarm);
    EXPECT_NEAR(r.integral, 1, 1e-4);
}

// The triangle is folded out to the square by reflection, so that cells are not cut.
TEST_F(Warp, TriangleIsUniform) {
    Random random(4);
    const auto draw = [&]() -> std::optional<dvec2> {
        const vec2 u = random.next2();
        const vec2 b = square_to_triangle(u);
        EXPECT_GE(b.x, 0);
        EXPECT_GE(b.y, 0);
        EXPECT_LE(b.x + b.y, 1);
        return random.next() < 0.5f ? dvec2(b) : dvec2(1) - dvec2(b);
    };
    expect_follows(test_square_density({40, 40}, samples, draw, [](double, double) { return 1.0; }),
                   alarm);
}

TEST_F(Warp, VisibleNormalsFollowTheirDensity) {
    Random random(5);
    for (const float alpha : {0.05f, 0.3f, 1.0f})
        for (const float z : {1.0f, 0.5f, 0.05f}) {
            SCOPED_TRACE(testing::Message() << "alpha " << alpha << " cos " << z);
            const vec3 w = direction_from_z(z, 0.13f);
            // Cells in v, with tan^2 = (alpha^2) (1 / (1 - v)^2 - 1): no singularity at the
            // horizon.
            const auto draw = [&]() -> std::optional<dvec2> {
                const vec3 h = sample_ggx_visible(w, alpha, random.next2());
                const double sin2 = double(h.x) * h.x + double(h.y) * h.y;
                const double t = sin2 / (sqr(double(h.z)) * sqr(double(alpha)));
                const double x = std::atan2(double(h.y), double(h.x)) / two_pi;
                return dvec2(x < 0 ? x + 1 : x, 1 - 1 / std::sqrt(1 + t));
            };
            const auto density = [&](double x, double v) {
                const double tan2 = sqr(double(alpha)) * (1 / sqr(1 - v) - 1);
                const double c = 1 / std::sqrt(1 + tan2), s = std::sqrt(tan2) * c;
                const vec3 h(dvec3(s * std::cos(two_pi * x), s * std::sin(two_pi * x), c));
                // d(omega) = cos^3 / 2 d(tan^2) d(phi), d(tan^2) = 2 alpha^2 / (1 - v)^3 dv.
                return double(ggx_visible_pdf_w(w, h, alpha)) * c * c * c * two_pi *
                       sqr(double(alpha)) / ((1 - v) * (1 - v) * (1 - v));
            };
            const DensityResult r = test_square_density({24, 24}, samples, draw, density);
            EXPECT_GT(r.test.p_value, sidak_level(alarm, 9));
            // The rim of what w sees cuts slivers off cells, which the integral's grid misses.
            EXPECT_LE(r.test.impossible, 1e-4 * samples);
            EXPECT_NEAR(r.integral, 1, 2e-3);
        }
}

TEST_F(Warp, EveryRandomNumberGivesADensity) {
    for (const float x : {0.0f, 0x1p-24f, 0.25f, 0.5f, last})
        for (const float y : {0.0f, 0x1p-24f, 0.5f, 0.75f, last}) {
            SCOPED_TRACE(testing::Message() << x << ' ' << y);
            const vec3 c = square_to_cosine_hemisphere({x, y});
            EXPECT_GT(cosine_hemisphere_pdf_w(c.z), 0);
            EXPECT_NEAR(glm::length(c), 1, 1e-6);
            EXPECT_NEAR(glm::length(square_to_sphere({x, y})), 1, 1e-6);
            EXPECT_LE(glm::length(square_to_disc({x, y})), 1 + 1e-6);
            for (const float alpha : {1e-3f, 1.0f})
                for (const float z : {1e-4f, 1.0f}) {
                    const vec3 w = direction_from_z(z, 0.3f);
                    const vec3 h = sample_ggx_visible(w, alpha, {x, y});
                    EXPECT_TRUE(is_finite(h));
                    EXPECT_TRUE(std::isfinite(ggx_visible_pdf_w(w, h, alpha)));
                }
        }
}

TEST_F(Warp, FramesAreOrthonormalAndRightHanded) {
    Random random(6);
    for (int i = 0; i < 10000; ++i) {
        const vec3 n = i == 0 ? vec3(0, 0, -1) : square_to_sphere(random.next2());
        const Frame f = frame_from_normal(n);
        EXPECT_NEAR(glm::length(f.s), 1, 1e-6);
        EXPECT_NEAR(glm::dot(f.s, f.n), 0, 1e-6);
        EXPECT_LT(glm::length(glm::cross(f.s, f.t) - n), 2e-6);
    }
}

using Discrete = WorkerMode;

TEST_F(Discrete, PicksFollowTheWeightsAndLeaveAUniformRest) {
    const std::vector<double> weights = {0, 3, 0, 0, 1e-9, 5, 2, 0, 7, 0};
    const Distribution1D d = make_distribution(weights);
    Random random(7);
    std::vector<double> picks(weights.size()), rest(32), expected(weights.size());
    for (int i = 0; i < samples; ++i) {
        const DiscreteSample s = sample_discrete(d, random.next());
        EXPECT_EQ(s.probability, d.probability(s.index));
        EXPECT_GT(s.probability, 0);
        ++picks[s.index];
        ++rest[static_cast<int>(s.remapped * 32)];
    }
    for (size_t i = 0; i < weights.size(); ++i) expected[i] = samples * weights[i] / (17 + 1e-9);
    const ChiSquare of_picks = chi_square_test(picks, expected);
    EXPECT_GT(of_picks.p_value, sidak_level(alarm, 2));
    EXPECT_EQ(of_picks.impossible, 0);
    EXPECT_GT(chi_square_test(rest, std::vector<double>(32, samples / 32.0)).p_value,
              sidak_level(alarm, 2));
}

TEST_F(Discrete, NeverPicksWhatHasNoProbability) {
    const Distribution1D d = make_distribution({0, 0, 1, 0, 2, 0, 0});
    for (const double u : {0.0, 1.0 / 3, std::nextafter(1.0 / 3, 0.0), double(last),
                           std::nextafter(1.0, 0.0), 1.0}) {
        const DiscreteSample s = sample_discrete(d, u);
        EXPECT_GT(s.probability, 0) << u;
        EXPECT_LE(s.remapped, last) << u;
    }
    EXPECT_EQ(make_distribution({0, 0}).total, 0);
}

TEST_F(Discrete, CellsOfAGridFollowTheWeights) {
    Random random(8);
    const int width = 7, height = 5;
    std::vector<double> weights(width * height), cells(width * height), expected(width * height);
    double sum = 0;
    for (size_t i = 0; i < weights.size(); ++i)
        sum += weights[i] = i % 7 == 3 || i / 7 == 2 ? 0.0 : 1 + double(i % 5);
    const Distribution2D d = make_distribution_2d(weights, width, height);
    for (int i = 0; i < samples; ++i) {
        const CellSample s = sample_cell(d, random.next2());
        EXPECT_NEAR(s.probability, cell_probability(d, s.x, s.y), 1e-15);
        ++cells[s.y * width + s.x];
    }
    for (size_t i = 0; i < weights.size(); ++i) {
        expected[i] = samples * weights[i] / sum;
        EXPECT_NEAR(cell_probability(d, int(i) % width, int(i) / width), weights[i] / sum, 1e-14);
    }
    const ChiSquare r = chi_square_test(cells, expected);
    EXPECT_GT(r.p_value, alarm);
    EXPECT_EQ(r.impossible, 0);
}

}  // namespace
}  // namespace midway::test
