#include <set>

#include "image/png.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include "unit/image_test_files.h"

namespace midway {
namespace {

using test::file_bytes;
using test::one_line_error;
using test::TempFolder;

struct Bytes {
    int width = 0, height = 0, channels = 0;
    std::vector<unsigned char> values;
    int at(int x, int y, int c) const { return values[(size_t(y) * width + x) * 3 + c]; }
};

Bytes written_and_read(const Image& image, const ToneMap& tone = {}) {
    TempFolder folder;
    write_png(folder.file("x.png"), image, tone);
    Bytes bytes;
    unsigned char* data =
        stbi_load(folder.file("x.png").c_str(), &bytes.width, &bytes.height, &bytes.channels, 3);
    EXPECT_NE(data, nullptr);
    if (data) bytes.values.assign(data, data + size_t(bytes.width) * bytes.height * 3);
    stbi_image_free(data);
    return bytes;
}

// IEC 61966-2-1 in double, written down a second time.
double encode(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Image constant_image(int size, const vec3& value) {
    Image image(size, size);
    for (vec3& p : image.pixels) p = value;
    return image;
}

TEST(PngImage, EveryValueIsWithinOneStep) {
    Image image(257, 33);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.at(x, y) = vec3(x / 256.0f, y / 32.0f, x * y / 8192.0f);
    const Bytes bytes = written_and_read(image);
    ASSERT_EQ(bytes.width, 257);
    ASSERT_EQ(bytes.height, 33);
    EXPECT_EQ(bytes.channels, 3);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c)
                ASSERT_LT(std::abs(bytes.at(x, y, c) - 255 * encode(image.at(x, y)[c])), 1.001)
                    << x << "," << y << " channel " << c;
}

TEST(PngImage, DitheringKeepsTheMean) {
    for (double step : {0.13, 0.5, 1.25, 17.01, 99.75, 127.5, 200.37, 254.6}) {
        const float linear = static_cast<float>(decode(step / 255));
        const Bytes bytes = written_and_read(constant_image(128, vec3(linear)));
        double sum = 0;
        for (unsigned char v : bytes.values) sum += v;
        EXPECT_NEAR(sum / double(bytes.values.size()), step, 0.02);
    }
}

TEST(PngImage, DitheringHasNoLargeSpots) {
    const Bytes bytes =
        written_and_read(constant_image(128, vec3(static_cast<float>(decode(100.5 / 255)))));
    for (int y = 0; y + 8 <= 128; y += 8)
        for (int x = 0; x + 8 <= 128; x += 8) {
            double sum = 0;
            for (int i = 0; i < 64; ++i) sum += bytes.at(x + i % 8, y + i / 8, 1);
            EXPECT_NEAR(sum / 64, 100.5, 0.1);  // white noise would spread by 0.06, to 0.25
        }
}

TEST(PngImage, GreysStayGreyAndPureValuesPure) {
    const Bytes grey = written_and_read(constant_image(32, vec3(0.2345f)));
    for (size_t i = 0; i < grey.values.size(); i += 3) {
        ASSERT_EQ(grey.values[i], grey.values[i + 1]);
        ASSERT_EQ(grey.values[i], grey.values[i + 2]);
    }
    const Bytes pure = written_and_read(constant_image(32, vec3(0, 1, 7)));
    for (size_t i = 0; i < pure.values.size(); i += 3) {
        ASSERT_EQ(pure.values[i], 0);
        ASSERT_EQ(pure.values[i + 1], 255);
        ASSERT_EQ(pure.values[i + 2], 255);
    }
}

TEST(PngImage, WhatIsNotFiniteIsClipped) {
    const float inf = std::numeric_limits<float>::infinity();
    for (Curve curve : {Curve::srgb, Curve::filmic}) {
        const Bytes bytes =
            written_and_read(constant_image(2, vec3(NAN, inf, -inf)), {130.0f, curve});
        EXPECT_EQ(bytes.at(0, 0, 0), 0);
        EXPECT_EQ(bytes.at(0, 0, 1), 255);
        EXPECT_EQ(bytes.at(0, 0, 2), 0);
    }
}

TEST(PngImage, SameImageSameBytesAndNothingButPixels) {
    TempFolder folder;
    Image image(40, 30);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = vec3(static_cast<float>(i) / 1200.0f);
    write_png(folder.file("a.png"), image, {});
    write_png(folder.file("b.png"), image, {});
    const std::string bytes = file_bytes(folder.file("a.png"));
    EXPECT_EQ(bytes, file_bytes(folder.file("b.png")));
    std::string chunks;
    for (size_t at = 8; at + 12 <= bytes.size();) {
        const auto* b = reinterpret_cast<const unsigned char*>(bytes.data()) + at;
        chunks += bytes.substr(at + 4, 4);
        at += 12 + (size_t(b[0]) << 24 | size_t(b[1]) << 16 | size_t(b[2]) << 8 | b[3]);
    }
    EXPECT_EQ(chunks, "IHDRIDATIEND");
}

TEST(PngImage, RefusesAnImageWithoutPixels) {
    TempFolder folder;
    one_line_error([&] { write_png(folder.file("x.png"), Image(), {}); });
    EXPECT_EQ(folder.entries(), 0);
}

TEST(ToneMap, TransferFunctionHasTheStandardsValues) {
    EXPECT_NEAR(srgb_from_linear(0.214041140f), 0.5, 1e-6);
    EXPECT_NEAR(srgb_from_linear(0.18f), 0.461356, 1e-5);
    EXPECT_NEAR(srgb_from_linear(0.002f), 0.02584, 1e-7);
    EXPECT_EQ(srgb_from_linear(0), 0);
    EXPECT_EQ(srgb_from_linear(1), 1);
    EXPECT_LT(srgb_from_linear(std::nextafter(1.0f, 0.0f)), 1.0f);
}

TEST(ToneMap, ExposureCountsInStops) {
    const vec3 light(0.01f, 0.2f, 0.05f);
    EXPECT_EQ(tone_map(light, {2}), tone_map(light * 4.0f, {0}));
    EXPECT_EQ(tone_map(light, {-1}), tone_map(light * 0.5f, {0}));
}

TEST(ToneMap, FilmicRisesWithoutEnd) {
    float before = -1;
    for (float light = 0; light < 8; light += 0.01f) {
        const float now = tone_map(vec3(light), {0, Curve::filmic}).x;
        EXPECT_GE(now, before);
        EXPECT_LE(now, 1);
        before = now;
    }
    EXPECT_EQ(tone_map(vec3(1e30f), {0, Curve::filmic}).x, 1);
}

TEST(AutoExposure, TakesAGreyToMiddleGrey) {
    EXPECT_NEAR(auto_exposure(constant_image(16, vec3(0.18f))), 0, 1e-5);
    EXPECT_NEAR(auto_exposure(constant_image(16, vec3(0.18f * 8))), -3, 1e-5);
    EXPECT_NEAR(auto_exposure(constant_image(1, vec3(0.045f))), 2, 1e-5);
}

TEST(AutoExposure, TheLogarithmIsAveraged) {
    Image image = constant_image(16, vec3(0.18f * 4));
    for (size_t i = 0; i < image.pixels.size(); i += 2) image.pixels[i] = vec3(0.18f / 4);
    EXPECT_NEAR(auto_exposure(image), 0, 1e-5);
}

TEST(AutoExposure, BackgroundAndFirefliesHaveNoSay) {
    Image image = constant_image(64, vec3(0.36f));
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        if (i % 2) image.pixels[i] = vec3(i % 4 == 1 ? 0.0f : 1e-6f);
        if (i % 500 == 0) image.pixels[i] = vec3(1e7f);
        if (i == 6) image.pixels[i] = vec3(NAN);
        if (i == 8) image.pixels[i] = vec3(std::numeric_limits<float>::infinity());
        if (i == 10) image.pixels[i] = vec3(-5);
    }
    EXPECT_NEAR(auto_exposure(image), -1, 1e-4);
}

TEST(AutoExposure, DarknessNeedsNone) {
    EXPECT_EQ(auto_exposure(Image()), 0);
    EXPECT_EQ(auto_exposure(constant_image(8, vec3(0))), 0);
}

}  // namespace
}  // namespace midway
