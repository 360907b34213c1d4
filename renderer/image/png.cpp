#include "image/png.h"

#include <memory>
#include <stdexcept>

#include "image/exr.h"
#include "image/file.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace midway {
namespace {

// Interleaved gradient noise in [0, 1).
double dither_noise(int x, int y) {
    double inner = 0.06711056 * x + 0.00583715 * y;
    double outer = 52.9829189 * (inner - std::floor(inner));
    return outer - std::floor(outer);
}

uint8_t quantise(float encoded, double noise) {
    if (encoded <= 0) return 0;
    if (encoded >= 1) return 255;
    return static_cast<uint8_t>(std::min(255.0, std::floor(encoded * 255.0 + noise)));
}

// `where` is for messages.
std::string encode(const Image& linear, const ToneMap& tone, const std::string& where) {
    const int width = linear.width, height = linear.height;
    if (width < 1 || height < 1 || width > max_image_pixels / height ||
        linear.pixels.size() != static_cast<size_t>(width) * height)
        throw std::runtime_error("cannot write PNG image: it has no pixels or too many (" +
                                 one_line(where) + "); choose another size");
    std::vector<uint8_t> bytes(linear.pixels.size() * 3);
    uint8_t* out = bytes.data();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const vec3 encoded = tone_map(linear.at(x, y), tone);
            const double noise = dither_noise(x, y);
            for (int i = 0; i < 3; ++i) *out++ = quantise(encoded[i], noise);
        }
    int size = 0;
    std::unique_ptr<unsigned char, void (*)(void*)> png(
        stbi_write_png_to_mem(bytes.data(), width * 3, width, height, 3, &size), std::free);
    if (!png)
        throw std::runtime_error("cannot write PNG image: out of memory (" + one_line(where) +
                                 "); choose a smaller size");
    return {reinterpret_cast<const char*>(png.get()), static_cast<size_t>(size)};
}

void check_size(const std::string& path, int width, int height, size_t pixels) {
    if (width < 1 || height < 1 || width > max_image_pixels / height ||
        pixels != static_cast<size_t>(width) * height)
        throw std::runtime_error("cannot write PNG image: it has no pixels or too many (" +
                                 one_line(path) + "); choose another size");
}

// `encode` turns a pixel into values in [0, 1].
template <class Encode>
void write_dithered(const std::string& path, const Image& image, const Encode& encode) {
    check_size(path, image.width, image.height, image.pixels.size());
    std::vector<uint8_t> bytes(image.pixels.size() * 3);
    uint8_t* out = bytes.data();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const vec3 encoded = encode(image.at(x, y));
            const double noise = dither_noise(x, y);
            for (int i = 0; i < 3; ++i) *out++ = quantise(encoded[i], noise);
        }
    write_png_bytes(path, image.width, image.height, bytes);
}

}  // namespace

void write_png(const std::string& path, const Image& linear, const ToneMap& tone) {
    write_dithered(path, linear, [&](const vec3& c) { return tone_map(c, tone); });
}

void write_encoded_png(const std::string& path, const Image& encoded) {
    write_dithered(path, encoded, [](const vec3& c) { return c; });
}

void write_png_bytes(const std::string& path, int width, int height,
                     const std::vector<std::uint8_t>& bytes) {
    check_size(path, width, height, bytes.size() / 3);
    int size = 0;
    std::unique_ptr<unsigned char, void (*)(void*)> png(
        stbi_write_png_to_mem(bytes.data(), width * 3, width, height, 3, &size), std::free);
    if (!png)
        throw std::runtime_error("cannot write PNG image: out of memory (" + one_line(where) +
                                 "); choose a smaller size");
    return {reinterpret_cast<const char*>(png.get()), static_cast<size_t>(size)};
}

}  // namespace

std::string encode_png(const Image& linear, const ToneMap& tone) {
    return encode(linear, tone, "in memory");
}

void write_png(const std::string& path, const Image& linear, const ToneMap& tone) {
    atomic_write(path, encode(linear, tone, path));
}

}  // namespace midway
