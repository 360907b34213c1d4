#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "image/metrics.h"
#include "report/error_log.h"
#include "report/reference.h"
#include "support/temp_dir.h"

namespace midway {
namespace {

constexpr int width = 40, height = 30;

// What is to be rendered: no two pixels alike, some of them black.
vec3 truth(int x, int y) {
    return vec3(0.05f * float((7 * x + 3 * y) % 23), 0.02f * float(x), 0.3f);
}

// A film of passes whose samples are truth x exponential noise: independent, mean 1, variance 1.
Film noisy_film(std::uint64_t passes, unsigned seed) {
    Film film(width, height, film_unit_exponent(1));
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> noise;
    FixedCounts counts;
    for (std::uint64_t pass = 0; pass < passes; ++pass)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                FixedRgb v;
                for (int c = 0; c < 3; ++c)
                    v[c] = to_fixed(truth(x, y)[c] * float(noise(random)), film.unit_exponent(),
                                    counts);
                EXPECT_TRUE(film.add(int(pass & 1), x, y, v));
            }
    return film;
}

Image true_image() {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y) = truth(x, y);
    return image;
}

// Errors against a noisy reference, its variance subtracted, are those against the truth: over 40
// pairs of references and images the mean difference is within 4.4 standard errors of 0 (false
// alarm 1e-5 a figure). Without the subtraction both are a third too high, far outside.
TEST(NoisyReference, ItsVarianceIsSubtractedWithoutBias) {
    const Image exact = true_image();
    RunningMean mse, relmse;
    for (unsigned i = 0; i < 40; ++i) {
        const Film one = noisy_film(31, 100 + 3 * i), two = noisy_film(30, 101 + 3 * i);
        const FilmPart parts[] = {{&one, pass_counts(0, 31)}, {&two, pass_counts(0, 30)}};
        const Reference r = reference_of_films(parts);
        ASSERT_TRUE(r.variance);
        EXPECT_EQ(r.spp, 61u);
        const Film film = noisy_film(20, 102 + 3 * i);
        const ErrorPoint p = measure_error(r, film, pass_counts(0, 20), {});
        const ImageError e =
            compare_images(resolve(film, pass_counts(0, 20)), exact, {{}, {}, false});
        mse.add(p.mse / e.mse - 1);
        relmse.add(p.relmse / e.relmse - 1);
    }
    EXPECT_LT(std::abs(mse.mean), 4.4 * mse.estimate().standard_error);
    // The denominators keep the noise of the reference (metrics.h): v / r^2 is 1/61, the error
    // 1/20.
    const double margin = 4.4 * relmse.estimate().standard_error;
    EXPECT_GT(relmse.mean, -margin);
    EXPECT_LT(relmse.mean, 3.0 / 61 + 6.0 / 61 * 20 / 61 + margin);
}

TEST(NoisyReference, FloorIsItsOwnError) {
    const Film film = noisy_film(64, 7);
    const FilmPart part{&film, pass_counts(0, 64)};
    const Reference r = reference_of_films({&part, 1});
    const ReferenceFloor floor = reference_floor(r);
    const ImageError e = compare_images(r.image, true_image(), {{}, {}, false});
    // One difference in each of 3600 values: 3 % standard error each.
    EXPECT_NEAR(floor.mse / e.mse, 1, 0.2);
    EXPECT_NEAR(floor.relmse / e.relmse, 1, 0.2);
    EXPECT_NEAR(floor.relmse_trimmed / e.relmse_trimmed, 1, 0.2);
    EXPECT_LT(floor.relmse_trimmed, floor.relmse);
    // Of two halves the variance is a quarter of their squared difference.
    const Image v = resolve_variance(film, pass_counts(0, 64));
    for (size_t i = 0; i < v.pixels.size(); ++i)
        EXPECT_NEAR(r.variance->pixels[i].x, v.pixels[i].x, 1e-6 * (v.pixels[i].x + 1e-6));
}

TEST(NoisyReference, ComesBackFromAnExrWithItsVariance) {
    const test::TempDir dir;
    const Film film = noisy_film(16, 8);
    const FilmPart part{&film, pass_counts(0, 16)};
    const Reference r = reference_of_films({&part, 1});
    const std::string path = (dir.path() / "r.exr").string();
    write_exr(path, {{"", r.image}, {"variance", *r.variance}}, {});
    const Reference back = load_reference(path);
    EXPECT_EQ(reference_hash(back), reference_hash(r));
    EXPECT_GT(back.luminance.estimate.standard_error, 0);
    write_exr(path, {{"", r.image}}, {});
    EXPECT_FALSE(load_reference(path).variance);
    EXPECT_TRUE(std::isnan(reference_floor(load_reference(path)).relmse));
    EXPECT_THROW(check_reference_size(back, 3, 4, path), std::runtime_error);
}

// z of right images is standard normal: mean and mean square of 300 within 4.4 standard errors
// (false alarm 2e-5); with a quarter planted, z is beyond 5 in every one.
TEST(ErrorRow, BiasIsTestedByTheHalves) {
    Reference exact;
    exact.image = true_image();
    exact.luminance.estimate.mean = mean_luminance(exact.image);
    Reference dim = exact;
    dim.luminance.estimate.mean *= 0.8;
    for (vec3& p : dim.image.pixels) p *= 0.8f;
    RunningMean z;
    double squares = 0;
    for (unsigned i = 0; i < 300; ++i) {
        const Film film = noisy_film(12, 500 + i);
        const double v = measure_error(exact, film, pass_counts(0, 12), {}).bias_z;
        z.add(v);
        squares += v * v / 300;
        EXPECT_GT(measure_error(dim, film, pass_counts(0, 12), {}).bias_z, 5);
    }
    EXPECT_LT(std::abs(z.mean), 4.4 / std::sqrt(300.0));
    EXPECT_NEAR(squares, 1, 4.4 * std::sqrt(2.0 / 300));
    const Film one = noisy_film(1, 1);
    EXPECT_TRUE(std::isnan(measure_error(exact, one, pass_counts(0, 1), {}).bias_z));
}

TEST(ErrorRow, EstimateNeedsNoReference) {
    const Image exact = true_image();
    const Film film = noisy_film(200, 3);
    const ImageError e = compare_images(resolve(film, pass_counts(0, 200)), exact, {{}, {}, false});
    EXPECT_NEAR(estimate_relmse(film, pass_counts(0, 200)) / e.relmse, 1, 0.15);
    EXPECT_TRUE(std::isinf(estimate_relmse(noisy_film(1, 1), pass_counts(0, 1))));
    // A firefly in one half does not hide itself in the denominator.
    Film firefly = film;
    FixedCounts counts;
    const Int128 bright = to_fixed(200 * 100.0f, film.unit_exponent(), counts);
    ASSERT_TRUE(firefly.add(0, 20, 20, {bright, bright, bright}));
    EXPECT_GT(estimate_relmse(firefly, pass_counts(0, 200)),
              10 / double(width * height) + estimate_relmse(film, pass_counts(0, 200)));
}

// A window has means and variances alone; at even numbers of passes nothing but rounding is lost.
TEST(ErrorRow, SnapshotsGiveTheNumbersOfTheirFilms) {
    Reference exact;
    exact.image = true_image();
    exact.luminance.estimate.mean = mean_luminance(exact.image);
    for (const std::uint64_t passes : {2, 9, 16, 34}) {
        Film film = noisy_film(passes, 900);
        FixedCounts counts;
        const Int128 bright = to_fixed(30.0f, film.unit_exponent(), counts);
        for (const int half : {0, 1})
            ASSERT_TRUE(film.add(half, 3 + half, 7, {bright, bright, bright}));
        const PassCounts n = pass_counts(0, passes);
        const Image mean = resolve(film, n), variance = resolve_variance(film, n);
        const std::optional<double> estimated = estimate_relmse(mean, variance, n);
        ASSERT_EQ(estimated.has_value(), passes % 2 == 0);
        if (estimated) {
            EXPECT_NEAR(*estimated / estimate_relmse(film, n), 1, 1e-4) << passes;
        }
        const ErrorPoint p = measure_error(exact, film, n, {1, 2});
        const ErrorPoint q = measure_error(exact, mean, passes, {1, 2});
        EXPECT_EQ(p.relmse, q.relmse);
        EXPECT_EQ(p.relmse_trimmed, q.relmse_trimmed);
        EXPECT_EQ(p.bias, q.bias);
        EXPECT_EQ(p.spp, q.spp);
        EXPECT_TRUE(std::isnan(q.bias_z));
    }
    EXPECT_FALSE(estimate_relmse(exact.image, Image(3, 2), pass_counts(0, 2)));
}

TEST(ErrorRow, IsMeasuredAtTheSamePassesWhereverItBegins) {
    std::vector<std::uint64_t> grid;
    for (std::uint64_t n = 0; grid.size() < 18; grid.push_back(n)) n = next_measured_pass(n);
    EXPECT_EQ(grid, (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28,
                                                32, 40, 48}));
    for (std::uint64_t n = 32; n < 40; ++n) EXPECT_EQ(next_measured_pass(n), 40u);
}

TEST(ErrorRow, ReadsBackAsTheSameBits) {
    ErrorPoint p;
    p.seconds = 0.1;
    p.cpu_seconds = 1.0 / 3;
    p.spp = 7;
    p.mse = 1e-300;
    p.bias_z = std::nan("");
    EXPECT_EQ(error_csv_row("bdpt", 0.5, 9, p),
              "bdpt,0.5,9,0.1,0.3333333333333333,7,1e-300,0,0,0,0,0,\n");
    EXPECT_EQ(error_csv_header(),
              "technique,exponent,seed,seconds,cpu_seconds,spp,mse,rmse,relmse,relmse_trimmed,"
              "smape,bias,bias_z\n");
}

}  // namespace
}  // namespace midway
