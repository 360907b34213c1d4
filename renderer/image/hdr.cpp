#include "image/hdr.h"

#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "image/exr.h"
#include "image/file.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace midway {
namespace {

struct Source {
    std::ifstream in;
    int64_t size = 0;
    bool in_pixels = false;  // the header is known to be whole
    bool cut_short = false;  // the decoder asked for more than there is
};

// Hands bytes to the decoder. In the header it is told of the end. In the pixels it is not, since
// it takes an end for zeros, and run lengths of zero never end: it gets 0xFF for ever and the cut
// is noted. It reads ahead by whole buffers, where getting less is no fault, and by at most one
// pixel of four bytes, where it is.
int read_bytes(void* user, char* data, int size) {
    Source& source = *static_cast<Source*>(user);
    source.in.read(data, size);
    const int got = static_cast<int>(source.in.gcount());
    if (got == size || (got > 0 && size > 4) || !source.in_pixels) return got;
    source.cut_short = true;
    std::memset(data + got, 0xFF, static_cast<size_t>(size - got));
    return size;
}

void skip_bytes(void* user, int count) {
    static_cast<Source*>(user)->in.seekg(count, std::ios::cur);
}

int at_end(void* user) {
    Source& source = *static_cast<Source*>(user);
    return source.cut_short || source.in.peek() == std::ifstream::traits_type::eof();
}

// Fewest bytes that can hold the pixels: four runs of at most 127 a row, or four bytes a pixel.
int64_t least_size(int64_t width, int64_t height) {
    const bool runs_possible = width >= 8 && width < 32768;
    return height * (runs_possible ? 4 + 8 * ((width + 126) / 127) : 4 * width);
}

void rewind(Source& source) {
    source.in.clear();
    source.in.seekg(0);
}

Image decode(Source& source) {
    const stbi_io_callbacks callbacks{read_bytes, skip_bytes, at_end};
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_callbacks(&callbacks, &source, &width, &height, &channels))
        throw std::runtime_error("the header is damaged or of a kind that is not read");
    if (width < 1 || height < 1 || width > max_image_pixels / height)
        throw std::runtime_error("an image of " + std::to_string(width) + " x " +
                                 std::to_string(height) + " pixels cannot be read");
    if (source.size < least_size(width, height)) throw std::runtime_error("the file is cut short");

    rewind(source);
    source.in_pixels = true;
    std::unique_ptr<float, void (*)(void*)> values(
        stbi_loadf_from_callbacks(&callbacks, &source, &width, &height, &channels, 3),
        stbi_image_free);
    if (source.cut_short) throw std::runtime_error("the file is cut short");
    if (!values) throw std::runtime_error(stbi_failure_reason());
    Image image(width, height);
    std::memcpy(image.pixels.data(), values.get(), image.pixels.size() * sizeof(vec3));
    return image;
}

}  // namespace

LoadedImage read_hdr(const std::string& path) {
    try {
        Source source;
        source.in.open(path, std::ios::binary | std::ios::ate);
        if (!source.in) throw std::runtime_error("it cannot be opened");
        source.size = source.in.tellg();
        rewind(source);
        LoadedImage loaded;
        loaded.image = decode(source);
        return loaded;
    } catch (const std::exception& error) {
        throw std::runtime_error("cannot read Radiance HDR image: " + one_line(error.what()) +
                                 " (" + one_line(path) +
                                 "); save it again as RGBE with rows from the top, or as EXR");
    }
}

}  // namespace midway
