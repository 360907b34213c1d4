#include <array>

#include "image/image.h"
#include "unit/image_test_files.h"

namespace midway {
namespace {

using test::one_line_error;
using test::put_bytes;
using test::TempFolder;

using Rgbe = std::array<unsigned char, 4>;

std::string header(int width, int height, const char* format = "32-bit_rle_rgbe") {
    return std::string("#?RADIANCE\n# a comment\nFORMAT=") + format + "\nEXPOSURE=1.0\n\n-Y " +
           std::to_string(height) + " +X " + std::to_string(width) + "\n";
}

Rgbe test_pixel(int x, int y) {
    return {static_cast<unsigned char>(128 + x % 3), static_cast<unsigned char>(64 + y),
            static_cast<unsigned char>(x / 7), static_cast<unsigned char>(126 + y % 5)};
}

vec3 decoded(const Rgbe& p) { return vec3(p[0], p[1], p[2]) * std::ldexp(1.0f, p[3] - 136); }

std::string flat_file(int width, int height) {
    std::string file = header(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (unsigned char c : test_pixel(x, y)) file += static_cast<char>(c);
    return file;
}

// Run-length encoded rows: runs where values repeat, single values where they do not.
std::string rle_file(int width, int height) {
    std::string file = header(width, height);
    for (int y = 0; y < height; ++y) {
        file += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
        for (int c = 0; c < 4; ++c)
            for (int x = 0; x < width;) {
                const unsigned char value = test_pixel(x, y)[c];
                int run = 1;
                while (x + run < width && run < 127 && test_pixel(x + run, y)[c] == value) ++run;
                file += static_cast<char>(run > 1 ? 128 + run : 1);
                file += static_cast<char>(value);
                x += run;
            }
    }
    return file;
}

void expect_test_pixels(const Image& image) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            ASSERT_EQ(image.at(x, y), decoded(test_pixel(x, y))) << x << "," << y;
}

TEST(HdrImage, ReadsFlatAndRunLengthRows) {
    TempFolder folder;
    put_bytes(folder.file("flat"), flat_file(5, 4));
    put_bytes(folder.file("rle"), rle_file(300, 17));
    const LoadedImage flat = read_image(folder.file("flat"));
    ASSERT_EQ(flat.image.width, 5);
    ASSERT_EQ(flat.image.height, 4);
    expect_test_pixels(flat.image);
    const LoadedImage rle = read_image(folder.file("rle"));
    ASSERT_EQ(rle.image.width, 300);
    ASSERT_EQ(rle.image.height, 17);
    expect_test_pixels(rle.image);
    EXPECT_TRUE(rle.layers.empty());
}

TEST(HdrImage, AHalfBrightPixelIsOneHalf) {
    TempFolder folder;
    put_bytes(folder.file("x"), header(1, 1) + "\x80\x40\x20\x80");
    EXPECT_EQ(read_image(folder.file("x")).image.at(0, 0), vec3(0.5f, 0.25f, 0.125f));
}

TEST(HdrImage, EveryCutIsAnError) {
    TempFolder folder;
    for (const std::string& whole : {flat_file(7, 33), rle_file(200, 32)}) {
        for (int i = 0; i < 16; ++i) {
            put_bytes(folder.file("x"), whole.substr(0, whole.size() * i / 16));
            one_line_error([&] { read_image(folder.file("x")); });
        }
        for (size_t cut = 1; cut < 300; ++cut) {
            put_bytes(folder.file("x"), whole.substr(0, whole.size() - cut));
            one_line_error([&] { read_image(folder.file("x")); });
        }
    }
}

TEST(HdrImage, RunsOfZeroLengthEnd) {
    TempFolder folder;
    put_bytes(folder.file("x"), header(64, 64) + "\x02\x02" + std::string(8000, '\0'));
    one_line_error([&] { read_image(folder.file("x")); });
    std::string zeros = header(64, 4);
    zeros += {2, 2, 0, 64};
    put_bytes(folder.file("x"), zeros + std::string(8000, '\0'));
    one_line_error([&] { read_image(folder.file("x")); });
}

TEST(HdrImage, AHeaderWithoutAnEndEnds) {
    TempFolder folder;
    put_bytes(folder.file("x"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nno blank line\n-Y 4 +X 4\n" +
                                    std::string(4000, '\xff'));
    one_line_error([&] { read_image(folder.file("x")); });
    put_bytes(folder.file("x"), std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1"));
    one_line_error([&] { read_image(folder.file("x")); });
}

TEST(HdrImage, RefusesOtherKindsAndSizes) {
    TempFolder folder;
    const std::string data(4096, '\x80');
    for (const std::string& head :
         {header(4, 4, "32-bit_rle_xyze"), header(0, 4), header(4, -4), header(1 << 20, 1 << 20),
          header(32768, 32768), header(2147483647, 2147483647),
          std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 4 +X 4\n"),
          std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 4 -Y 4\n"),
          std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n")}) {
        put_bytes(folder.file("x"), head + data);
        const std::string message = one_line_error([&] { read_image(folder.file("x")); });
        EXPECT_NE(message.find(folder.file("x")), std::string::npos) << message;
    }
}

TEST(HdrImage, DamageNeverCrashes) {
    TempFolder folder;
    const std::string whole = rle_file(40, 12);
    uint32_t state = 7;
    for (int i = 0; i < 2000; ++i) {
        std::string damaged = whole;
        for (int k = 0; k < 3; ++k) {
            state = state * 1664525u + 1013904223u;
            damaged[(state >> 8) % damaged.size()] = static_cast<char>(state >> 24);
        }
        put_bytes(folder.file("x"), damaged);
        try {
            const Image image = read_image(folder.file("x")).image;
            ASSERT_EQ(image.pixels.size(), static_cast<size_t>(image.width) * image.height);
        } catch (const std::runtime_error&) {
        }
    }
}

TEST(ImageFile, RefusesWhatIsNoImage) {
    TempFolder folder;
    put_bytes(folder.file("empty"), "");
    put_bytes(folder.file("png"), "\x89PNG\r\n\x1a\n");
    for (const std::string& name :
         {folder.file("empty"), folder.file("png"), folder.file("missing"),
          folder.dir.path().string(), std::string("/dev/null"), folder.file("two\nlines")}) {
        one_line_error([&] { read_image(name); });
    }
}

}  // namespace
}  // namespace midway
