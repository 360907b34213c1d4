// What Midway writes comes back to the last bit; the errors that it makes in writing are lines.
#include <OpenEXR/ImfThreading.h>

#include <bit>
#include <chrono>
#include <cstring>
#include <limits>
#include <thread>

#include "image/image.h"
#include "unit/image_test_files.h"

namespace midway {
namespace {

using test::file_bytes;
using test::one_line_error;
using test::put_bytes;
using test::TempFolder;

Image noise_image(int width, int height, uint32_t state) {
    Image image(width, height);
    for (vec3& p : image.pixels)
        for (int c = 0; c < 3; ++c) {
            state = state * 1664525u + 1013904223u;
            p[c] = static_cast<float>(state >> 8) / 16777216.0f - 0.25f;
        }
    return image;
}

bool same_bits(const Image& a, const Image& b) {
    return a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(vec3)) == 0;
}

TEST(ExrImage, LayersAndMetadataComeBack) {
    TempFolder folder;
    const Image main = noise_image(37, 21, 1), a = noise_image(37, 21, 2),
                raw = noise_image(37, 21, 3), depth = noise_image(37, 21, 4);
    const Metadata metadata = {{"midway.spp", "64"},
                               {"empty", ""},
                               {"comments", "two\nlines, \xc3\xa4"},
                               {std::string(255, 'k'), std::string(70000, 'v')}};
    write_exr(folder.file("x.exr"),
              {{"s2t3", a}, {"", main}, {"s2t3.raw", raw}, {"depth", depth, true}}, metadata);
    const LoadedImage loaded = read_image(folder.file("x.exr"));
    EXPECT_TRUE(same_bits(loaded.image, main));
    ASSERT_EQ(loaded.layers.size(), 3u);
    EXPECT_EQ(loaded.layers[0].name, "depth");
    EXPECT_EQ(loaded.layers[1].name, "s2t3");
    EXPECT_EQ(loaded.layers[2].name, "s2t3.raw");
    EXPECT_TRUE(loaded.layers[0].scalar);
    EXPECT_FALSE(loaded.layers[1].scalar);
    EXPECT_TRUE(same_bits(loaded.layers[1].image, a));
    EXPECT_TRUE(same_bits(loaded.layers[2].image, raw));
    for (size_t i = 0; i < depth.pixels.size(); ++i)
        ASSERT_EQ(loaded.layers[0].image.pixels[i], vec3(depth.pixels[i].x));
    EXPECT_EQ(loaded.metadata, metadata);
    EXPECT_EQ(folder.entries(), 1);
}

TEST(ExrImage, EveryBitComesBack) {
    TempFolder folder;
    Image image(64, 300);
    uint32_t state = 5;
    for (vec3& p : image.pixels)
        for (int c = 0; c < 3; ++c) {
            state = state * 1664525u + 1013904223u;
            p[c] = std::bit_cast<float>(state);  // any kind of number, NaNs included
        }
    using Limits = std::numeric_limits<float>;
    image.pixels[0] = vec3(Limits::denorm_min(), -Limits::denorm_min(), -0.0f);
    image.pixels[1] = vec3(Limits::max(), Limits::lowest(), Limits::min() / 3);
    image.pixels[2] = vec3(Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN());
    write_exr(folder.file("x.exr"), {{"", image}}, {});
    EXPECT_TRUE(same_bits(read_image(folder.file("x.exr")).image, image));
}

TEST(ExrImage, AFileOfOneScalarIsGrey) {
    TempFolder folder;
    const Image image = noise_image(5, 4, 1);
    for (const char* name : {"", "mask"}) {
        write_exr(folder.file("x.exr"), {{name, image, true}}, {});
        const LoadedImage loaded = read_image(folder.file("x.exr"));
        EXPECT_EQ(loaded.image.at(3, 2), vec3(image.at(3, 2).x)) << name;
    }
}

TEST(ExrImage, WithoutAMainImageTheFirstColourLayerShows) {
    TempFolder folder;
    const Image a = noise_image(5, 4, 1), b = noise_image(5, 4, 2), z = noise_image(5, 4, 3);
    write_exr(folder.file("x.exr"), {{"b", b}, {"a", a, true}, {"c", z}}, {});
    const LoadedImage loaded = read_image(folder.file("x.exr"));
    EXPECT_TRUE(same_bits(loaded.image, b));
    EXPECT_EQ(loaded.layers.size(), 3u);
}

TEST(ExrImage, ReplacesAnOlderFile) {
    TempFolder folder;
    write_exr(folder.file("x.exr"), {{"", noise_image(50, 40, 1)}}, {});
    const Image image = noise_image(3, 2, 2);
    write_exr(folder.file("x.exr"), {{"", image}}, {});
    EXPECT_TRUE(same_bits(read_image(folder.file("x.exr")).image, image));
    EXPECT_EQ(folder.entries(), 1);
}

TEST(ExrImage, TheSameImageGivesTheSameBytes) {
    TempFolder folder;
    const Image image = noise_image(50, 40, 1);
    write_exr(folder.file("a.exr"), {{"", image}}, {{"seed", "1"}});
    write_exr(folder.file("b.exr"), {{"", image}}, {{"seed", "1"}});
    EXPECT_EQ(file_bytes(folder.file("a.exr")), file_bytes(folder.file("b.exr")));
}

TEST(ExrImage, RefusesLayersThatMakeNoFile) {
    TempFolder folder;
    const Image image = noise_image(5, 4, 1);
    const std::vector<std::vector<ImageLayer>> wrong = {
        {},
        {{"", Image()}},
        {{"", image}, {"a", noise_image(4, 5, 1)}},
        {{"a", image}, {"b", image}, {"a", image, true}},
        {{std::string(254, 'n'), image}},
        {{std::string("a\0b", 3), image}}};
    for (const auto& layers : wrong)
        one_line_error([&] { write_exr(folder.file("x.exr"), layers, {}); });
    Image lying = image;
    lying.height = 400;
    one_line_error([&] { write_exr(folder.file("x.exr"), {{"", lying}}, {}); });
    for (const std::string& key :
         {std::string(), std::string(256, 'k'), std::string("type"), std::string("channels"),
          std::string("dataWindow"), std::string("a\0b", 3)})
        one_line_error([&] { write_exr(folder.file("x.exr"), {{"", image}}, {{key, "1"}}); });
    one_line_error([&] { write_exr(folder.file("no/x.exr"), {{"", image}}, {}); });
    EXPECT_EQ(folder.entries(), 0);
}

TEST(ExrImage, StartsNoThreads) {
    TempFolder folder;
    auto threads = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
    };
    const auto before = threads();
    Imf::setGlobalThreadCount(3);
    write_exr(folder.file("x.exr"), {{"", noise_image(200, 200, 1)}}, {});
    EXPECT_EQ(Imf::globalThreadCount(), 0);
    Imf::setGlobalThreadCount(3);
    read_image(folder.file("x.exr"));
    EXPECT_EQ(Imf::globalThreadCount(), 0);
    // A thread that has been joined may be listed for a moment, those of other cases too.
    for (int i = 0; i < 100 && threads() > before; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_LE(threads(), before);
}

}  // namespace
}  // namespace midway
