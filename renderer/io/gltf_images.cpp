#include "io/gltf_images.h"

#include <climits>
#include <new>
#include <stdexcept>

// Only the two formats of glTF, as private code of this file: stb_image's other decoders have known
// holes and must not be reachable from a scene file.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace midway::gltf {
namespace {

constexpr int not_loaded = -2, unusable = -1;

Bytes encoded_bytes(const Document& document, const ImageSource& source) {
    if (source.view < 0) {
        if (source.uri.empty()) throw std::runtime_error("it names no data");
        return read_uri(document.path, source.uri);
    }
    const ByteSpan bytes = view_bytes(document, source.view);
    return Bytes(bytes.begin(), bytes.end());
}

// Throws std::runtime_error with the reason alone.
std::shared_ptr<TextureImage> decode(const Bytes& bytes, std::int64_t& texels_left) {
    if (bytes.empty() || bytes.size() > INT_MAX) throw std::runtime_error("impossible size");
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels)) {
        throw std::runtime_error(std::string("not a PNG or JPEG that can be read: ") +
                                 stbi_failure_reason());
    }
    const std::int64_t texels = std::int64_t{width} * height;
    if (texels <= 0 || texels > max_image_texels) throw std::runtime_error("more than 2^26 texels");
    if (texels > texels_left) throw std::runtime_error("more than 2^29 texels in all images");
    stbi_uc* data = stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4);
    if (!data) throw std::runtime_error(std::string("damaged: ") + stbi_failure_reason());
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> owner(data, stbi_image_free);
    texels_left -= texels;
    auto image = std::make_shared<TextureImage>();
    image->width = width;
    image->height = height;
    image->rgba.assign(data, data + texels * 4);
    return image;
}

}  // namespace

int load_image(Document& document, ImageTable& table, int image, SceneDescription& scene) {
    const ImageSource& source = at(document, document.images, image, "image");
    table.scene_image.resize(document.images.size(), not_loaded);
    int& loaded = table.scene_image[static_cast<std::size_t>(image)];
    if (loaded != not_loaded) return loaded;
    loaded = unusable;
    const bool named_by_uri = source.uri.size() < 256 && source.uri.find("data:") != 0;
    const std::string name = source.name.empty() && named_by_uri ? source.uri : source.name;
    const auto leave_out = [&](const std::string& why) {
        warn(document,
             "image " + std::to_string(image) + " \"" + printable(name) + "\" is left out: " + why);
    };
    try {
        auto decoded = decode(encoded_bytes(document, source), table.texels_left);
        decoded->name = printable(name);
        scene.images.push_back(std::move(decoded));
        loaded = static_cast<int>(scene.images.size()) - 1;
    } catch (const std::bad_alloc&) {
        leave_out("out of memory");
    } catch (const std::runtime_error& error) {
        leave_out(error.what());
    }
    return loaded;
}

}  // namespace midway::gltf
