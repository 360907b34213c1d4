// Camera and pixel filters: film and lens sampling, and that camera samples and splats see one and
// the same filter. False-alarm rate of each random case: 1e-4, shared. Held with 20 other seeds.
#include "scene/camera.h"

#include <gtest/gtest.h>

#include "image/pixel_filter.h"
#include "support/density.h"
#include "support/scenes.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

constexpr double alarm = 1e-4;
constexpr FilterKind filters[] = {FilterKind::box, FilterKind::gaussian,
                                  FilterKind::blackman_harris};
using Filter = WorkerMode;
using CameraRays = WorkerMode;

TEST_F(Filter, SamplesFollowTheFilter) {
    Random random(1);
    for (const FilterKind kind : filters) {
        const PixelFilter f = make_filter(kind);
        const double width = 2 * f.radius;
        const auto draw = [&]() -> std::optional<dvec2> {
            return dvec2(sample_filter(f, random.next2())) / width + 0.5;
        };
        const auto density = [&](double x, double y) {
            return sqr(width) * filter_value(f, float((x - 0.5) * width)) *
                   filter_value(f, float((y - 0.5) * width));
        };
        const DensityResult r = test_square_density({32, 32}, 200'000, draw, density);
        EXPECT_GT(r.test.p_value, sidak_level(alarm, 3)) << int(kind);
        EXPECT_NEAR(r.integral, 1, 1e-4) << int(kind);
    }
}

// A splat's expectation at pixel j is the filter of the distance, for every place on the film:
// exactly, by summing over a fine grid of random numbers.
TEST_F(Filter, SplatsRealiseTheSameFilter) {
    constexpr int n = 4096;
    for (const FilterKind kind : filters) {
        const PixelFilter f = make_filter(kind);
        for (const float x : {10.0f, 10.1f, 10.49f, 10.5f, 10.77f, 10.999f, 0.2f, -0.3f}) {
            std::vector<double> got(16);
            for (int i = 0; i < n; ++i) {
                const SplatPixel s = choose_splat_pixel(f, {x, 5.5f}, {(i + 0.5f) / n, 0.5f});
                got[s.x + 3] += s.factor / n;
            }
            // The other axis: the sum over its pixels, which is not one for a tabulated filter.
            double across = 0;
            for (int j = 0; j < 12; ++j) across += filter_value(f, 5.5f - (j + 0.5f));
            for (int j = -3; j < 13; ++j)
                EXPECT_NEAR(got[j + 3], filter_value(f, x - (j + 0.5f)) * across, 3e-3)
                    << int(kind) << " at " << x << " pixel " << j;
        }
    }
}

// Camera samples drawn by the filter and splats of uniform light give a pixel the same mean of any
// picture, here of a wedge with a bright line.
TEST_F(Filter, CameraSamplesAndSplatsAgree) {
    const auto picture = [](const vec2& p) {
        return 0.3 * p.x + 0.1 * p.y + (std::abs(p.x - p.y - 0.8f) < 0.2f ? 3.0 : 0.0);
    };
    for (const FilterKind kind : filters) {
        const PixelFilter f = make_filter(kind);
        Random random(2);
        constexpr int samples = 400'000;
        RunningMean gathered, splatted;
        for (int i = 0; i < samples; ++i) {
            gathered.add(picture(vec2(4.5f, 3.5f) + sample_filter(f, random.next2())));
            const vec2 at = vec2(2, 1) + 5.0f * random.next2();
            const SplatPixel s = choose_splat_pixel(f, at, random.next2());
            splatted.add(s.x == 4 && s.y == 3 ? 25 * picture(at) * s.factor : 0);
        }
        EXPECT_GT(z_test(gathered.estimate(), splatted.estimate()), sidak_level(alarm, 3))
            << int(kind);
    }
}

TEST_F(Filter, RefusesWhatIsFarOutside) {
    const PixelFilter f = make_filter(FilterKind::gaussian);
    EXPECT_EQ(choose_splat_pixel(f, {1e30f, 0}, {0.5f, 0.5f}).factor, 0);
    EXPECT_EQ(choose_splat_pixel(f, {0, std::nanf("")}, {0.5f, 0.5f}).factor, 0);
}

Camera thin_lens(float aperture) {
    CameraDescription d = camera_at({1, 2, 3}, {0, 0.5f, -1}, 0.9);
    d.aperture_radius = aperture;
    d.focus_distance = 2.5;
    return make_camera(d, {}, 40, 30);
}

// Directions through a pixel's area have the density of camera_pdf_w.
TEST_F(CameraRays, DirectionsFollowTheirDensity) {
    Random random(3);
    const Camera c = thin_lens(0);
    const auto draw = [&]() -> std::optional<vec3> {
        const vec2 u = random.next2();
        return camera_direction(c, c.position, vec2(u.x * c.width, u.y * c.height));
    };
    const auto pdf = [&](const vec3& w) -> double {
        const auto p = film_position(c, c.position, w);
        if (!p || p->x < 0 || p->y < 0 || p->x > c.width || p->y > c.height) return 0;
        return camera_pdf_w(c, glm::dot(w, c.forward)) / (double(c.width) * c.height);
    };
    const DensityResult r =
        test_sphere_density({c.right, c.up, c.forward}, {32, 256}, 200'000, draw, pdf);
    EXPECT_GT(r.test.p_value, alarm);
    EXPECT_NEAR(r.integral, 1, 2e-3);
}

TEST_F(CameraRays, LensIsSampledUniformlyInItsPlane) {
    Random random(4);
    const Camera c = thin_lens(0.2f);
    const auto draw = [&]() -> std::optional<dvec2> {
        const vec3 d = lens_point(c, random.next2()) - c.position;
        EXPECT_NEAR(glm::dot(d, c.forward), 0, 1e-6);
        return dvec2(glm::dot(d, c.right), glm::dot(d, c.up)) / 0.4 + 0.5;
    };
    const auto density = [](double x, double y) {
        return sqr(2 * x - 1) + sqr(2 * y - 1) < 1 ? 4 / 3.14159265358979 : 0.0;
    };
    EXPECT_GT(test_square_density({32, 32}, 200'000, draw, density).test.p_value, alarm);
}

// Rays through all of the lens meet in the plane of focus, and land on the film where they began.
TEST_F(CameraRays, FilmPositionInvertsDirections) {
    Random random(5);
    for (const float aperture : {0.0f, 0.3f}) {
        const Camera c = thin_lens(aperture);
        for (int i = 0; i < 10'000; ++i) {
            const vec2 film = random.next2() * vec2(60, 50) - 10.0f;
            const vec3 lens = lens_point(c, random.next2());
            const vec3 w = camera_direction(c, lens, film);
            const auto back = film_position(c, lens, w);
            ASSERT_TRUE(back);
            EXPECT_LT(glm::length(*back - film), 2e-4f);
            EXPECT_FALSE(film_position(c, lens, -w));
            if (aperture == 0) continue;
            const vec3 focus = lens + w * (2.5f / glm::dot(w, c.forward));
            const vec3 center =
                c.position +
                camera_direction(thin_lens(0), c.position, film) * 2.5f /
                    glm::dot(camera_direction(thin_lens(0), c.position, film), c.forward);
            EXPECT_LT(glm::length(focus - center), 1e-4f);
        }
    }
}

}  // namespace
}  // namespace midway::test
