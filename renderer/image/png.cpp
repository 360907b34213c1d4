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

// In what follows `where` is for messages.
void check_size(const std::string& where, int width, int height, size_t pixels) {
    if (width < 1 || height < 1 || width > max_image_pixels / height ||
        pixels != static_cast<size_t>(width) * height)
        throw std::runtime_error("cannot write PNG image: it has no pixels or too many (" +
                                 one_line(where) + "); choose another size");
}

std::string compress(const std::string& where, int width, int height,
                     const std::vector<uint8_t>& rgb) {
    check_size(where, width, height, rgb.size() / 3);
    int size = 0;
    std::unique_ptr<unsigned char, void (*)(void*)> png(
        stbi_write_png_to_mem(rgb.data(), width * 3, width, height, 3, &size), std::free);
    if (!png)
        throw std::runtime_error("cannot write PNG image: out of memory (" + one_line(where) +
                                 "); choose a smaller size");
    return {reinterpret_cast<const char*>(png.get()), static_cast<size_t>(size)};
}

// `encoded_of` turns a pixel into values in [0, 1].
template <class Encode>
std::string dithered(const std::string& where, const Image& image, const Encode& encoded_of) {
    check_size(where, image.width, image.height, image.pixels.size());
    std::vector<uint8_t> bytes(image.pixels.size() * 3);
    uint8_t* out = bytes.data();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const vec3 encoded = encoded_of(image.at(x, y));
            const double noise = dither_noise(x, y);
            for (int i = 0; i < 3; ++i) *out++ = quantise(encoded[i], noise);
        }
    return compress(where, image.width, image.height, bytes);
}

std::string dithered(const std::string& where, const Image& linear, const ToneMap& tone) {
    return dithered(where, linear, [&](const vec3& c) { return tone_map(c, tone); });
}

}  // namespace

std::string encode_png(const Image& linear, const ToneMap& tone) {
    return dithered("in memory", linear, tone);
}

void write_png(const std::string& path, const Image& linear, const ToneMap& tone) {
    atomic_write(path, dithered(path, linear, tone));
}

void write_encoded_png(const std::string& path, const Image& encoded) {
    atomic_write(path, dithered(path, encoded, [](const vec3& c) { return c; }));
}

void write_png_bytes(const std::string& path, int width, int height,
                     const std::vector<std::uint8_t>& rgb) {
    atomic_write(path, compress(path, width, height, rgb));
}

}  // namespace midway
