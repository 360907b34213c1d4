#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <fstream>
#include <set>
#include <stdexcept>

#include "image/exr.h"
#include "image/file.h"

namespace midway {
namespace {

constexpr size_t max_name = 255;  // of the file format

// Names of a layer's channels: three, or one for a scalar.
std::vector<std::string> channel_names(const ImageLayer& layer) {
    const std::string prefix = layer.name.empty() ? "" : layer.name + ".";
    if (layer.scalar) return {prefix + (layer.name.empty() ? "Y" : "V")};
    return {prefix + "R", prefix + "G", prefix + "B"};
}

void check_layers(const std::vector<ImageLayer>& layers) {
    if (layers.empty()) throw std::runtime_error("there is no layer to write");
    const Image& first = layers.front().image;
    std::set<std::string> names;
    for (const auto& [name, image, scalar] : layers) {
        if (image.width < 1 || image.height < 1 || image.width > max_image_pixels / image.height ||
            image.pixels.size() != static_cast<size_t>(image.width) * image.height)
            throw std::runtime_error("layer '" + name + "' has no pixels or too many");
        if (image.width != first.width || image.height != first.height)
            throw std::runtime_error("layer '" + name + "' differs in size from the first");
        if (name.size() > max_name - 2 || name.find('\0') != std::string::npos)
            throw std::runtime_error("a layer's name is too long or holds a zero byte");
        if (!names.insert(name).second)
            throw std::runtime_error("two layers have the name '" + name + "'");
    }
}

Imf::Header make_header(const std::vector<ImageLayer>& layers, const Metadata& metadata) {
    const Image& first = layers.front().image;
    Imf::Header header(first.width, first.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [key, value] : metadata) {
        // "type" would turn the file into one of a kind that it is not.
        if (key.empty() || key.size() > max_name || key.find('\0') != std::string::npos ||
            key == "type")
            throw std::runtime_error("'" + key + "' cannot be the name of an attribute");
        header.insert(key, Imf::StringAttribute(value));
    }
    return header;
}

void describe_channels(const std::vector<ImageLayer>& layers, Imf::Header& header,
                       Imf::FrameBuffer& frame) {
    for (const ImageLayer& layer : layers) {
        // OpenEXR reads through a pointer to non-const.
        char* base = const_cast<char*>(reinterpret_cast<const char*>(layer.image.pixels.data()));
        for (const std::string& name : channel_names(layer)) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            frame.insert(
                name, Imf::Slice(Imf::FLOAT, base, sizeof(vec3), sizeof(vec3) * layer.image.width));
            base += sizeof(float);
        }
    }
}

[[noreturn]] void fail(const std::string& path, const std::string& why, const char* remedy) {
    throw std::runtime_error("cannot write EXR image: " + one_line(why) + " (" + one_line(path) +
                             "); " + remedy);
}

}  // namespace

void write_exr(const std::string& path, const std::vector<ImageLayer>& layers,
               const Metadata& metadata) {
    Imf::setGlobalThreadCount(0);
    Imf::Header header;
    Imf::FrameBuffer frame;
    try {
        check_layers(layers);
        header = make_header(layers, metadata);
        describe_channels(layers, header, frame);
    } catch (const std::exception& error) {
        fail(path, error.what(), "give layers of one size and other names");
    }
    atomic_write(path, [&](std::ofstream& out) {
        try {
            Imf::StdOFStream stream(out, path.c_str());
            Imf::OutputFile file(stream, header, 0);
            file.setFrameBuffer(frame);
            file.writePixels(layers.front().image.height);
        } catch (const std::exception& error) {
            fail(path, error.what(), "choose a folder that has free space");
        }
    });
}

}  // namespace midway
