#include <limits>

#include "image/flip.h"
#include "image/metrics.h"
#include "unit/image_test_files.h"

namespace midway {
namespace {

using test::one_line_error;

Image constant_image(int width, int height, const vec3& value) {
    Image image(width, height);
    for (vec3& p : image.pixels) p = value;
    return image;
}

// Deterministic values in [0, 1).
Image noise_image(int width, int height, uint32_t state) {
    Image image(width, height);
    for (vec3& p : image.pixels)
        for (int c = 0; c < 3; ++c) {
            state = state * 1664525u + 1013904223u;
            p[c] = static_cast<float>(state >> 8) / 16777216.0f;
        }
    return image;
}

TEST(ImageError, OfEqualImagesIsNothing) {
    const Image image = noise_image(31, 17, 1);
    const ImageError error = compare_images(image, image);
    EXPECT_EQ(error.mse, 0);
    EXPECT_EQ(error.rmse, 0);
    EXPECT_EQ(error.relmse, 0);
    EXPECT_EQ(error.relmse_trimmed, 0);
    EXPECT_EQ(error.smape, 0);
    EXPECT_EQ(error.flip, 0);
    EXPECT_EQ(error.mean_ratio, 1);
    EXPECT_EQ(bias(error), 0);
}

// Reference (1,1,1) (1,1,1), so m = 1; the image has 2 in one of six values.
TEST(ImageError, MatchesTheSumDoneByHand) {
    const Image reference = constant_image(2, 1, vec3(1));
    Image test = reference;
    test.at(1, 0).x = 2;
    const ImageError error = compare_images(test, reference);
    EXPECT_DOUBLE_EQ(error.mse, 1.0 / 6);
    EXPECT_DOUBLE_EQ(error.rmse, std::sqrt(1.0 / 6));
    EXPECT_DOUBLE_EQ(error.relmse, 1 / 1.01 / 6);
    EXPECT_DOUBLE_EQ(error.relmse_trimmed, error.relmse);
    EXPECT_DOUBLE_EQ(error.smape, 1.0 / 3 / 6);
    EXPECT_DOUBLE_EQ(error.mean_ratio, (1 + 1.2126) / 2);
    EXPECT_DOUBLE_EQ(bias(error), 0.2126 / 2);
}

// Reference (4,0,0) and (0,2,0): m = (4 * 0.2126 + 2 * 0.7152) / 2 = 1.1404.
TEST(ImageError, WeighsTheReferenceByLuminance) {
    Image reference(2, 1), test(2, 1);
    reference.at(0, 0) = vec3(4, 0, 0);
    reference.at(1, 0) = vec3(0, 2, 0);
    test.at(0, 0) = vec3(3, 0, -1);
    test.at(1, 0) = vec3(0, 2, 0.5f);
    const double floor = 0.01 * 1.1404 * 1.1404;
    const ImageError error = compare_images(test, reference);
    EXPECT_NEAR(error.relmse, (1 / (16 + floor) + 1 / floor + 0.25 / floor) / 6, 1e-12);
    EXPECT_NEAR(error.mse, 2.25 / 6, 1e-15);
    EXPECT_NEAR(error.smape, (1.0 / 7 + 1 + 1) / 6, 1e-15);
}

TEST(ImageError, EpsilonTakesThePlaceOfTheMean) {
    const Image reference = constant_image(2, 1, vec3(1));
    Image test = reference;
    test.at(1, 0).x = 2;
    EXPECT_DOUBLE_EQ(compare_images(test, reference, {{}, 0.5}).relmse, 1 / 1.5 / 6);
    EXPECT_DOUBLE_EQ(compare_images(test, reference, {{}, 0.0}).relmse, 1.0 / 6);
    for (double wrong : {-1.0, double(NAN), std::numeric_limits<double>::infinity()})
        one_line_error([&] { compare_images(test, reference, {{}, wrong}); });
}

TEST(ImageError, RelativeOnesDoNotChangeWithExposure) {
    Image test = noise_image(40, 30, 1), reference = noise_image(40, 30, 2);
    const ImageError before = compare_images(test, reference, {{}, {}, false});
    for (vec3& p : test.pixels) p *= 1024.0f;
    for (vec3& p : reference.pixels) p *= 1024.0f;
    const ImageError after = compare_images(test, reference, {{}, {}, false});
    EXPECT_GT(before.relmse, 0.1);
    EXPECT_DOUBLE_EQ(after.relmse, before.relmse);
    EXPECT_DOUBLE_EQ(after.relmse_trimmed, before.relmse_trimmed);
    EXPECT_DOUBLE_EQ(after.smape, before.smape);
    EXPECT_DOUBLE_EQ(after.mean_ratio, before.mean_ratio);
    EXPECT_DOUBLE_EQ(after.mse, before.mse * 1024 * 1024);
}

TEST(ImageError, TrimmingLeavesOutOnePixelInAThousand) {
    // Reference 1 everywhere; all pixels are off by 0.1 but for three: by 30, 20 and 10.
    const Image reference = constant_image(50, 40, vec3(1));
    Image test = constant_image(50, 40, vec3(1.25f));
    test.at(3, 3) = vec3(31);
    test.at(49, 39) = vec3(21);
    test.at(0, 0) = vec3(11);
    const ImageError error = compare_images(test, reference, {{}, {}, false});
    EXPECT_NEAR(error.relmse, (1997 * 0.0625 + 900 + 400 + 100) / 1.01 / 2000, 1e-12);
    EXPECT_NEAR(error.relmse_trimmed, (1997 * 0.0625 + 100) / 1.01 / 1998, 1e-12);
}

TEST(ImageError, TrimmingRoundsDownAndSurvivesTies) {
    const Image reference = constant_image(999, 1, vec3(1));
    Image test = constant_image(999, 1, vec3(2));
    test.at(5, 0) = vec3(101);
    ImageError error = compare_images(test, reference, {{}, {}, false});
    EXPECT_DOUBLE_EQ(error.relmse_trimmed, error.relmse);
    test.at(5, 0) = vec3(2);
    error = compare_images(test, reference, {{}, {}, false});
    EXPECT_NEAR(error.relmse_trimmed, 1 / 1.01, 1e-12);

    // 3000 pixels of which ten are equally bad: three go.
    test = constant_image(60, 50, vec3(1));
    for (int i = 0; i < 10; ++i) test.at(i, 3 * i) = vec3(3);
    error = compare_images(test, constant_image(60, 50, vec3(1)), {{}, {}, false});
    EXPECT_NEAR(error.relmse_trimmed, 7 * 4 / 1.01 / 2997, 1e-12);
}

TEST(ImageError, TrimmingGoesByPixelNotByChannel) {
    // One pixel is bad by 3 * 4, another by 10 in red alone: the first one goes.
    const Image reference = constant_image(1000, 1, vec3(1));
    Image test = reference;
    test.at(1, 0) = vec3(3);
    test.at(2, 0) = vec3(1 + std::sqrt(10.0f), 1, 1);
    const ImageError error = compare_images(test, reference, {{}, {}, false});
    EXPECT_NEAR(error.relmse_trimmed, 10 / 1.01 / 3 / 999, 1e-7);
}

TEST(ImageError, OnlyMaskedPixelsCount) {
    Image reference = constant_image(4, 2, vec3(5));
    Image test = reference;
    reference.at(1, 1) = vec3(2);
    test.at(1, 1) = vec3(3);
    reference.at(2, 0) = vec3(NAN);
    Image mask(4, 2);
    mask.at(1, 1) = vec3(0, 0, -0.5f);
    const ImageError error = compare_images(test, reference, {mask});
    EXPECT_DOUBLE_EQ(error.mse, 1);
    EXPECT_DOUBLE_EQ(error.relmse, 1 / (4 + 0.04));
    EXPECT_DOUBLE_EQ(error.mean_ratio, 1.5);
    EXPECT_TRUE(std::isfinite(error.flip));
}

TEST(ImageError, BlackIsNoDivisionByZero) {
    const Image black = constant_image(2, 2, vec3(0));
    const ImageError same = compare_images(black, black);
    EXPECT_EQ(same.relmse, 0);
    EXPECT_EQ(same.smape, 0);
    EXPECT_EQ(same.mean_ratio, 1);
    const ImageError other = compare_images(constant_image(2, 2, vec3(1)), black);
    EXPECT_EQ(other.smape, 1);
    EXPECT_TRUE(std::isinf(other.relmse));
    EXPECT_TRUE(std::isinf(other.mean_ratio));
}

TEST(ImageError, NamesTheFirstPixelThatIsNotFinite) {
    const Image good = noise_image(8, 6, 3);
    Image bad = good;
    bad.at(5, 4).y = std::numeric_limits<float>::infinity();
    bad.at(3, 2).z = NAN;
    std::string message = one_line_error([&] { compare_images(bad, good); });
    EXPECT_NE(message.find("image, pixel 3,2"), std::string::npos) << message;
    message = one_line_error([&] { compare_images(good, bad); });
    EXPECT_NE(message.find("reference, pixel 3,2"), std::string::npos) << message;
    message = one_line_error([&] { compare_images(good, good, {bad}); });
    EXPECT_NE(message.find("mask, pixel 3,2"), std::string::npos) << message;
}

TEST(ImageError, RefusesSizesThatDifferAndEmptyMasks) {
    const Image a = noise_image(8, 6, 3), b = noise_image(6, 8, 3);
    const std::string message = one_line_error([&] { compare_images(a, b); });
    EXPECT_NE(message.find("8 x 6"), std::string::npos) << message;
    EXPECT_NE(message.find("6 x 8"), std::string::npos) << message;
    one_line_error([&] { compare_images(a, a, {b}); });
    one_line_error([&] { compare_images(a, a, {Image(8, 6)}); });
    one_line_error([&] { compare_images(Image(), Image()); });
}

// Values that fit a float without rounding, so that any program can make the same pair.
void make_pair(Image& test, Image& reference) {
    test = reference = Image(48, 40);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 48; ++x) {
            const vec3 r(static_cast<float>((7 * x + 13 * y) % 33) / 32,
                         static_cast<float>((5 * x * y + 3) % 33) / 32,
                         static_cast<float>((x + y) % 33) / 32);
            reference.at(x, y) = r;
            test.at(x, y) = 0.75f * r + static_cast<float>((x * x + y) % 9) / 64;
        }
}

double mean(const std::vector<float>& values) {
    double sum = 0;
    for (float v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

// The expected numbers are from two other programs: one with whole two-dimensional kernels in
// double, and the authors' own (0.2698561 and 0.9673883).
TEST(Flip, AgreesWithOtherPrograms) {
    Image test, reference;
    make_pair(test, reference);
    EXPECT_NEAR(mean(flip_map(test, reference)), 0.2698561, 2e-6);
    EXPECT_NEAR(compare_images(test, reference).flip, 0.2698561, 2e-6);
    const Image black = constant_image(48, 40, vec3(0)), white = constant_image(48, 40, vec3(1));
    EXPECT_NEAR(mean(flip_map(black, white)), 0.96738, 2e-5);
}

TEST(Flip, IsSymmetricAndWithinRange) {
    Image test, reference;
    make_pair(test, reference);
    const std::vector<float> there = flip_map(test, reference);
    EXPECT_EQ(there, flip_map(reference, test));
    for (float v : there) {
        EXPECT_GE(v, 0);
        EXPECT_LE(v, 1);
    }
}

TEST(Flip, ClipsWhatADisplayCannotShow) {
    const Image white = constant_image(9, 9, vec3(1)), black = constant_image(9, 9, vec3(0));
    EXPECT_EQ(mean(flip_map(constant_image(9, 9, vec3(50)), white)), 0);
    EXPECT_EQ(mean(flip_map(constant_image(9, 9, vec3(-1)), black)), 0);
}

TEST(Flip, ADistantDifferenceIsSeenLess) {
    Image test, reference;
    make_pair(test, reference);
    EXPECT_GT(mean(flip_map(test, reference, 30)), mean(flip_map(test, reference, 120)));
}

TEST(Flip, ALonePixelIsAnImage) {
    EXPECT_NEAR(mean(flip_map(constant_image(1, 1, vec3(0)), constant_image(1, 1, vec3(1)))),
                0.96738, 2e-5);
}

}  // namespace
}  // namespace midway
