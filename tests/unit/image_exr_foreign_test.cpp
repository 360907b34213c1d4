// EXR files of other programs: kinds, windows and names of channels; and damaged ones.
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <cstring>

#include "image/image.h"
#include "support/shared_data.h"
#include "unit/image_test_files.h"

namespace midway {
namespace {

using glm::ivec3;
using test::file_bytes;
using test::one_line_error;
using test::put_bytes;
using test::TempFolder;

struct Channel {
    std::string name;
    Imf::PixelType type = Imf::FLOAT;
    int sampling = 1;
};

// What pixel (x, y) of channel number c holds; whole and small, so that every type can hold it.
float test_value(int x, int y, int c) { return static_cast<float>(x + 3 * y % 200 + 100 * c); }

// The data of a file with its data window at `origin`, in each channel's own type.
struct Source {
    Imath::Box2i window;
    Imf::Header header;
    Imf::FrameBuffer frame;
    std::vector<std::vector<char>> data;

    Source(const std::vector<Channel>& channels, const ivec2& size, const ivec2& origin,
           Imf::Compression compression)
        : window(Imath::V2i(origin.x, origin.y),
                 Imath::V2i(origin.x + size.x - 1, origin.y + size.y - 1)),
          header(Imath::Box2i(Imath::V2i(0, 0), Imath::V2i(99, 99)), window) {
        header.compression() = compression;
        for (size_t c = 0; c < channels.size(); ++c) {
            const auto& [name, type, sampling] = channels[c];
            header.channels().insert(name, Imf::Channel(type, sampling, sampling));
            const size_t bytes = type == Imf::HALF ? 2 : 4;
            std::vector<char>& d = data.emplace_back(bytes * size.x * size.y);
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const float value = test_value(x, y, static_cast<int>(c));
                    const half h(value);
                    const auto u = static_cast<uint32_t>(value);
                    const void* from = type == Imf::HALF    ? static_cast<const void*>(&h)
                                       : type == Imf::FLOAT ? static_cast<const void*>(&value)
                                                            : static_cast<const void*>(&u);
                    std::memcpy(d.data() + bytes * (size_t(y) * size.x + x), from, bytes);
                }
            frame.insert(name, Imf::Slice::Make(type, d.data(), window, bytes, bytes * size.x,
                                                sampling, sampling));
        }
    }
};

void write_scanlines(const std::string& path, const std::vector<Channel>& channels,
                     const ivec2& size = {9, 7}, const ivec2& origin = {0, 0},
                     Imf::Compression compression = Imf::ZIP_COMPRESSION,
                     Imf::LineOrder order = Imf::INCREASING_Y) {
    Source source(channels, size, origin, compression);
    source.header.lineOrder() = order;
    Imf::OutputFile file(path.c_str(), source.header, 0);
    file.setFrameBuffer(source.frame);
    file.writePixels(size.y);
}

void write_tiles(const std::string& path, const ivec2& size, const ivec2& origin,
                 Imf::LevelMode mode) {
    Source source({{"B"}, {"G", Imf::HALF}, {"R", Imf::UINT}}, size, origin, Imf::PIZ_COMPRESSION);
    source.header.setTileDescription(Imf::TileDescription(16, 24, mode));
    Imf::TiledOutputFile file(path.c_str(), source.header, 0);
    file.setFrameBuffer(source.frame);
    for (int level = 0; level < file.numLevels(); ++level)
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
}

void expect_values(const Image& image, const ivec2& size, const ivec3& channels) {
    ASSERT_EQ(image.width, size.x);
    ASSERT_EQ(image.height, size.y);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            for (int c = 0; c < 3; ++c)
                ASSERT_EQ(image.at(x, y)[c], channels[c] < 0 ? 0.0f : test_value(x, y, channels[c]))
                    << x << "," << y << " component " << c;
}

constexpr ivec3 rgb_of_bgr(2, 1, 0);

TEST(ForeignExr, EveryTypeWindowOrderAndCompression) {
    TempFolder folder;
    const std::string path = folder.file("x.exr");
    for (Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION})
        for (Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y})
            for (const ivec2& origin : {ivec2(0, 0), ivec2(-5, 7), ivec2(60, -300)}) {
                const ivec2 size(13, 530);  // more than two blocks of rows
                write_scanlines(path, {{"B", Imf::FLOAT}, {"G", Imf::HALF}, {"R", Imf::UINT}}, size,
                                origin, compression, order);
                expect_values(read_image(path).image, size, rgb_of_bgr);
            }
}

TEST(ForeignExr, ReferencesOfOtherRenderers) {
    MIDWAY_SKIP_WITHOUT_SHARED("peers/cbox_512.exr");
    const Image image = read_image(test::shared_path("peers/cbox_512.exr").string()).image;
    dvec3 mean(0);
    for (const vec3& p : image.pixels) mean += dvec3(p) / (512.0 * 512.0);
    EXPECT_NEAR(mean.x, 0.21878, 5e-6);
    EXPECT_NEAR(mean.y, 0.14248, 5e-6);
    EXPECT_NEAR(mean.z, 0.04044, 5e-6);
}

TEST(ForeignExr, Tiles) {
    TempFolder folder;
    for (Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS})
        for (const ivec2& origin : {ivec2(0, 0), ivec2(-5, 7)}) {
            const ivec2 size(37, 290);
            write_tiles(folder.file("x.exr"), size, origin, mode);
            expect_values(read_image(folder.file("x.exr")).image, size, rgb_of_bgr);
        }
}

TEST(ForeignExr, OfSeveralPartsTheFirst) {
    TempFolder folder;
    const std::string path = folder.file("x.exr");
    Source first({{"B"}, {"G"}, {"R"}}, {9, 7}, {1, 2}, Imf::ZIP_COMPRESSION);
    Source second({{"Y"}}, {5, 4}, {0, 0}, Imf::ZIP_COMPRESSION);
    first.header.setName("one");
    second.header.setName("two");
    for (Source* s : {&first, &second}) s->header.setType(Imf::SCANLINEIMAGE);
    {
        const Imf::Header headers[] = {first.header, second.header};
        Imf::MultiPartOutputFile file(path.c_str(), headers, 2, false, 0);
        Imf::OutputPart one(file, 0), two(file, 1);
        one.setFrameBuffer(first.frame);
        one.writePixels(7);
        two.setFrameBuffer(second.frame);
        two.writePixels(4);
    }
    const LoadedImage loaded = read_image(path);
    expect_values(loaded.image, {9, 7}, rgb_of_bgr);
    EXPECT_TRUE(loaded.layers.empty());
    // What was read can be written again with its attributes.
    write_exr(path, {{"", loaded.image}}, loaded.metadata);
    EXPECT_EQ(read_image(path).metadata.at("name"), "one");
}

TEST(ForeignExr, GreyAlphaAndColourWithGaps) {
    TempFolder folder;
    const std::string path = folder.file("x.exr");
    write_scanlines(path, {{"A"}, {"Y", Imf::HALF}});
    expect_values(read_image(path).image, {9, 7}, {1, 1, 1});
    EXPECT_TRUE(read_image(path).layers.empty());
    write_scanlines(path, {{"A"}, {"B"}, {"G"}, {"R"}});
    expect_values(read_image(path).image, {9, 7}, {3, 2, 1});
    EXPECT_TRUE(read_image(path).layers.empty());
    write_scanlines(path, {{"G"}, {"R"}});
    expect_values(read_image(path).image, {9, 7}, {1, 0, -1});
    write_scanlines(path, {{"Z"}});
    expect_values(read_image(path).image, {9, 7}, {0, 0, 0});
}

TEST(ForeignExr, ChannelsBecomeLayersByTheirNames) {
    TempFolder folder;
    const std::string path = folder.file("x.exr");
    write_scanlines(path, {{"B"},
                           {"G"},
                           {"R"},
                           {"Z"},
                           {"View.Combined.A"},
                           {"View.Combined.B"},
                           {"View.Combined.G"},
                           {"View.Combined.R"},
                           {"depth.Z"},
                           {"n.X"},
                           {"n.Y"},
                           {"n.Z"},
                           {"s2t3.raw.R"},
                           {"uv.u"},
                           {"uv.v"}});
    const LoadedImage loaded = read_image(path);
    expect_values(loaded.image, {9, 7}, rgb_of_bgr);
    struct Expected {
        const char* name;
        bool scalar;
        ivec3 channels;
    };
    const std::vector<Expected> expected = {
        {"Z", true, {3, 3, 3}},           {"View.Combined", false, {7, 6, 5}},
        {"depth", true, {8, 8, 8}},       {"n", false, {9, 10, 11}},
        {"s2t3.raw", true, {12, 12, 12}}, {"uv.u", true, {13, 13, 13}},
        {"uv.v", true, {14, 14, 14}}};
    ASSERT_EQ(loaded.layers.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(loaded.layers[i].name, expected[i].name);
        EXPECT_EQ(loaded.layers[i].scalar, expected[i].scalar) << expected[i].name;
        expect_values(loaded.layers[i].image, {9, 7}, expected[i].channels);
    }
}

TEST(ForeignExr, RefusesWhatItCannotShow) {
    TempFolder folder;
    const std::string path = folder.file("x.exr");
    write_scanlines(path, {{"B"}, {"G"}, {"R", Imf::HALF, 2}}, {8, 8});
    std::string message = one_line_error([&] { read_image(path); });
    EXPECT_NE(message.find("'R'"), std::string::npos) << message;
    write_scanlines(path, {{"BY"}, {"RY"}, {"Y"}});
    message = one_line_error([&] { read_image(path); });
    EXPECT_NE(message.find("chroma"), std::string::npos) << message;

    Imf::Header header(4, 4);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    {
        std::vector<unsigned> counts(16, 0);
        std::vector<float*> samples(16, nullptr);
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(
            Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), 16));
        frame.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()),
                                         sizeof(float*), 4 * sizeof(float*), sizeof(float)));
        Imf::DeepScanLineOutputFile file(path.c_str(), header, 0);
        file.setFrameBuffer(frame);
        file.writePixels(4);
    }
    message = one_line_error([&] { read_image(path); });
    EXPECT_NE(message.find("deep"), std::string::npos) << message;
}

// Puts four bytes at an offset behind the start of an attribute's value.
std::string patched(std::string bytes, const std::string& name_and_type, size_t offset,
                    uint32_t value) {
    const size_t at = bytes.find(name_and_type);
    EXPECT_NE(at, std::string::npos);
    for (int i = 0; i < 4; ++i)
        bytes[at + name_and_type.size() + offset + i] = static_cast<char>(value >> (8 * i));
    return bytes;
}

TEST(DamagedExr, SizesThatLieAreRefusedBeforeMemoryIsTaken) {
    TempFolder folder;
    write_scanlines(folder.file("a.exr"), {{"B"}, {"G"}, {"R"}});
    write_tiles(folder.file("b.exr"), {40, 40}, {0, 0}, Imf::ONE_LEVEL);
    const std::string lines = file_bytes(folder.file("a.exr"));
    const std::string tiles = file_bytes(folder.file("b.exr"));
    const std::string window("dataWindow\0box2i\0", 17), tile("tiles\0tiledesc\0", 15),
        channels("channels\0chlist\0", 16);
    const uint32_t big = 0x3fffffff, minus_one = 0xffffffff;
    for (const std::string& bytes :
         {patched(lines, window, 12, big), patched(lines, window, 16, big),
          patched(patched(lines, window, 12, big), window, 16, big),
          patched(lines, window, 12, minus_one), patched(lines, window, 4, 0x80000000),
          patched(lines, window, 0, 0x7fffffff), patched(lines, window, 0, minus_one),
          patched(lines, channels, 0, 0x7fffffff), patched(tiles, tile, 4, minus_one),
          patched(tiles, tile, 4, 0), patched(tiles, tile, 8, big)}) {
        put_bytes(folder.file("x.exr"), bytes);
        const std::string message = one_line_error([&] { read_image(folder.file("x.exr")); });
        EXPECT_NE(message.find(folder.file("x.exr")), std::string::npos) << message;
    }
}

TEST(DamagedExr, EveryCutIsAnError) {
    TempFolder folder;
    const std::vector<Channel> channels = {{"B"}, {"G", Imf::HALF}, {"R", Imf::UINT}, {"a.V"}};
    write_scanlines(folder.file("0.exr"), channels, {60, 50}, {0, 0}, Imf::NO_COMPRESSION);
    write_scanlines(folder.file("1.exr"), channels, {60, 50}, {0, 0}, Imf::ZIP_COMPRESSION);
    write_scanlines(folder.file("2.exr"), channels, {60, 50}, {0, 0}, Imf::PIZ_COMPRESSION);
    write_tiles(folder.file("3.exr"), {60, 50}, {0, 0}, Imf::ONE_LEVEL);
    for (const char* name : {"0.exr", "1.exr", "2.exr", "3.exr"}) {
        const std::string whole = file_bytes(folder.file(name));
        std::vector<size_t> cuts = {whole.size() - 1, whole.size() - 9, 3, 4, 5, 8, 9};
        for (size_t i = 0; i < 16; ++i) cuts.push_back(whole.size() * i / 16);
        for (size_t i = 10; i < 400; i += 7) cuts.push_back(i);  // the header
        for (size_t cut : cuts) {
            put_bytes(folder.file("x.exr"), whole.substr(0, cut));
            SCOPED_TRACE(std::string(name) + " cut at " + std::to_string(cut));
            one_line_error([&] { read_image(folder.file("x.exr")); });
        }
    }
}

TEST(DamagedExr, DamageNeverCrashes) {
    TempFolder folder;
    write_scanlines(folder.file("0.exr"), {{"B"}, {"G", Imf::HALF}, {"R", Imf::UINT}, {"a.V"}},
                    {20, 18}, {0, 0}, Imf::PIZ_COMPRESSION);
    write_tiles(folder.file("1.exr"), {20, 18}, {0, 0}, Imf::MIPMAP_LEVELS);
    uint32_t state = 11;
    for (const char* name : {"0.exr", "1.exr"}) {
        const std::string whole = file_bytes(folder.file(name));
        for (int i = 0; i < 1500; ++i) {
            std::string damaged = whole;
            for (int k = 0; k < 3; ++k) {
                state = state * 1664525u + 1013904223u;
                damaged[(state >> 8) % damaged.size()] = static_cast<char>(state >> 24);
            }
            put_bytes(folder.file("x.exr"), damaged);
            try {
                const Image image = read_image(folder.file("x.exr")).image;
                ASSERT_EQ(image.pixels.size(), static_cast<size_t>(image.width) * image.height);
            } catch (const std::runtime_error& error) {
                ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            }
        }
    }
}

}  // namespace
}  // namespace midway
