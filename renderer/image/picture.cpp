#include "image/picture.h"

#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace midway {
namespace {

constexpr int most_pixels_a_side = 4096;
constexpr size_t most_bytes = size_t{1} << 26;

std::vector<stbi_uc> read_bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot be opened");
    std::vector<stbi_uc> bytes;
    std::vector<char> part(1 << 16);
    while (in.read(part.data(), static_cast<std::streamsize>(part.size())) || in.gcount() > 0) {
        bytes.insert(bytes.end(), part.begin(), part.begin() + in.gcount());
        if (bytes.size() > most_bytes) throw std::runtime_error("is too large");
    }
    return bytes;
}

Picture decode(const std::vector<stbi_uc>& bytes) {
    const int size = static_cast<int>(bytes.size());
    Picture p;
    int channels = 0;
    if (!stbi_info_from_memory(bytes.data(), size, &p.width, &p.height, &channels))
        throw std::runtime_error("is neither PNG nor JPEG");
    if (p.width < 1 || p.height < 1 || p.width > most_pixels_a_side ||
        p.height > most_pixels_a_side)
        throw std::runtime_error("has too many pixels");
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> data(
        stbi_load_from_memory(bytes.data(), size, &p.width, &p.height, &channels, 4),
        stbi_image_free);
    if (!data) throw std::runtime_error("is damaged");
    p.rgba.assign(data.get(), data.get() + static_cast<size_t>(p.width) * p.height * 4);
    return p;
}

}  // namespace

Picture read_picture(const std::string& path) {
    try {
        return decode(read_bytes(path));
    } catch (const std::runtime_error& e) {
        throw std::runtime_error("the picture " + std::string(e.what()) + " (" + path +
                                 "); give a PNG or JPEG of at most 4096 pixels a side");
    }
}

}  // namespace midway
