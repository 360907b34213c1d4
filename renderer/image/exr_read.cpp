#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "image/exr.h"
#include "image/file.h"

namespace midway {
namespace {

// Where a channel of the file goes: one component of a layer's pixels.
struct Target {
    std::string channel;
    size_t layer = 0;
    int component = 0;
};

// What the file's channels make together; the main image is the layer without a name.
struct Plan {
    std::vector<ImageLayer> layers;
    std::vector<Target> targets;
};

using Group = std::vector<std::string>;  // the channels under one prefix, without the prefix

bool contains(const Group& group, const std::string& name) {
    return std::find(group.begin(), group.end(), name) != group.end();
}

int32_t read_int(std::istream& in) {
    unsigned char b[4] = {};
    in.read(reinterpret_cast<char*>(b), 4);
    return static_cast<int32_t>(b[0] | b[1] << 8 | b[2] << 16 | static_cast<uint32_t>(b[3]) << 24);
}

std::string read_name(std::istream& in) {
    std::string name;
    for (int c = in.get(); c > 0; c = in.get()) {
        if (name.size() == 255) throw std::runtime_error("a name in the header is too long");
        name += static_cast<char>(c);
    }
    if (!in) throw std::runtime_error("the header is cut short");
    return name;
}

// Walks the attributes of every header and checks that each lies inside the file: OpenEXR takes
// memory for what an attribute's size claims before it reads the attribute.
void check_headers(std::ifstream& in) {
    in.seekg(0, std::ios::end);
    const std::streamoff file_size = in.tellg();
    in.seekg(4);
    const bool multi_part = (read_int(in) & Imf::MULTI_PART_FILE_FLAG) != 0;
    bool first_attribute = true;
    while (true) {
        std::string name = read_name(in);
        if (name.empty()) {
            if (!multi_part || first_attribute) break;
            first_attribute = true;
            continue;
        }
        first_attribute = false;
        std::string type = read_name(in);
        int32_t size = read_int(in);
        if (!in || size < 0 || size > file_size - in.tellg())
            throw std::runtime_error("attribute '" + name + "' reaches past the end of the file");
        in.seekg(size, std::ios::cur);
    }
    in.clear();
    in.seekg(0);
}

void check_size(const Imf::Header& header) {
    const Imath::Box2i& window = header.dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > max_image_pixels || height > max_image_pixels / width)
        throw std::runtime_error("an image of " + std::to_string(width) + " x " +
                                 std::to_string(height) + " pixels cannot be read");
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            throw std::runtime_error("channel '" + std::string(c.name()) +
                                     "' is stored at a lower resolution");
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tile = header.tileDescription();
        if (tile.xSize < 1 || tile.ySize < 1 ||
            tile.ySize > static_cast<uint64_t>(max_image_pixels) / tile.xSize)
            throw std::runtime_error("the tile size is out of range");
    }
}

Imf::Header checked_header(std::ifstream& in, const std::string& path) {
    check_headers(in);
    in.seekg(4);
    int version = read_int(in);
    Imf::Header header;
    {
        Imf::StdIFStream stream(in, path.c_str());
        header.readFrom(stream, version);
    }
    if (header.hasType() && Imf::isDeepData(header.type()))
        throw std::runtime_error("deep images are not read");
    check_size(header);
    in.clear();
    in.seekg(0);
    return header;
}

void add_scalar(Plan& plan, const std::string& name, const std::string& channel) {
    plan.layers.push_back({name, {}, true});
    plan.targets.push_back({channel, plan.layers.size() - 1, 0});
}

// Takes the colour out of a group and leaves in it what is not colour.
void take_colour(Plan& plan, const std::string& prefix, Group& group) {
    const std::string layer = prefix.empty() ? "" : prefix.substr(0, prefix.size() - 1);
    const bool rgb = contains(group, "R") || contains(group, "G") || contains(group, "B");
    const bool xyz = contains(group, "X") && contains(group, "Y") && contains(group, "Z");
    Group taken;
    if (rgb) {
        taken = {"R", "G", "B"};
    } else if (!prefix.empty() && xyz) {
        taken = {"X", "Y", "Z"};
    } else if (prefix.empty() && contains(group, "Y")) {
        if (contains(group, "RY") || contains(group, "BY"))
            throw std::runtime_error("luminance-chroma images are not read");
        taken = {"Y"};
    } else {
        return;
    }
    plan.layers.push_back({layer, {}, taken.size() == 1});
    for (size_t i = 0; i < taken.size(); ++i)
        if (contains(group, taken[i]))
            plan.targets.push_back(
                {prefix + taken[i], plan.layers.size() - 1, static_cast<int>(i)});
    taken.push_back("A");
    std::erase_if(group, [&](const std::string& c) { return contains(taken, c); });
}

Plan make_plan(const Imf::ChannelList& channels) {
    std::map<std::string, Group> groups;
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        std::string name = c.name();
        size_t dot = name.rfind('.');
        size_t split = dot == std::string::npos ? 0 : dot + 1;
        groups[name.substr(0, split)].push_back(name.substr(split));
    }
    Plan plan;
    for (auto& [prefix, group] : groups) {
        if (prefix.size() > 1 && group.size() == 1) {
            add_scalar(plan, prefix.substr(0, prefix.size() - 1), prefix + group[0]);
            continue;
        }
        take_colour(plan, prefix, group);
        for (const std::string& rest : group) add_scalar(plan, prefix + rest, prefix + rest);
    }
    if (plan.layers.empty()) throw std::runtime_error("there are no channels");
    return plan;
}

// Reads in blocks and lets the images grow with them, so that a small file that claims to be large
// takes no more memory than it has pixels. A block is a multiple of every chunk's height.
void read_pixels(Imf::InputFile& file, Plan& plan) {
    const Imath::Box2i window = file.header().dataWindow();
    const size_t width = static_cast<size_t>(window.max.x - window.min.x + 1);
    const size_t height = static_cast<size_t>(window.max.y - window.min.y + 1);
    if (plan.layers.size() > max_image_values / 3 / (width * height))
        throw std::runtime_error(std::to_string(plan.layers.size()) + " layers of " +
                                 std::to_string(width) + " x " + std::to_string(height) +
                                 " pixels are too many");
    for (ImageLayer& layer : plan.layers) {
        layer.image.width = static_cast<int>(width);
        layer.image.height = static_cast<int>(height);
        layer.image.pixels.reserve(width * height);
    }
    Imf::FrameBuffer frame;
    for (const Target& target : plan.targets) {
        char* base = reinterpret_cast<char*>(plan.layers[target.layer].image.pixels.data()) +
                     static_cast<size_t>(target.component) * sizeof(float);
        frame.insert(target.channel, Imf::Slice::Make(Imf::FLOAT, base, window, sizeof(vec3),
                                                      sizeof(vec3) * width));
    }
    file.setFrameBuffer(frame);
    for (size_t row = 0; row < height; row += 256) {
        const size_t end = std::min(row + 256, height);
        for (ImageLayer& layer : plan.layers) layer.image.pixels.resize(end * width, vec3(0));
        file.readPixels(window.min.y + static_cast<int>(row),
                        window.min.y + static_cast<int>(end) - 1);
    }
    for (ImageLayer& layer : plan.layers)
        if (layer.scalar)
            for (vec3& p : layer.image.pixels) p = vec3(p.x);
}

LoadedImage sort_out(Plan& plan, const Imf::Header& header) {
    LoadedImage loaded;
    bool found = false;
    for (ImageLayer& layer : plan.layers) {
        const bool main = layer.name.empty() && !found;
        if (main) loaded.image = std::move(layer.image);
        if (!main) loaded.layers.push_back(std::move(layer));
        found |= main;
    }
    if (!found) {
        const ImageLayer* shown = &loaded.layers.front();
        for (const ImageLayer& layer : loaded.layers)
            if (shown->scalar && !layer.scalar) shown = &layer;
        loaded.image = shown->image;
    }
    for (auto a = header.begin(); a != header.end(); ++a) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute());
        if (text && std::strcmp(a.name(), "type") != 0) loaded.metadata[a.name()] = text->value();
    }
    return loaded;
}

}  // namespace

LoadedImage read_exr(const std::string& path) {
    try {
        Imf::setGlobalThreadCount(0);
        std::ifstream in(path, std::ios::binary);
        if (!in) throw std::runtime_error("it cannot be opened");
        const Imf::Header header = checked_header(in, path);
        Plan plan = make_plan(header.channels());
        Imf::StdIFStream stream(in, path.c_str());
        Imf::InputFile file(stream, 0);
        read_pixels(file, plan);
        return sort_out(plan, header);
    } catch (const std::exception& error) {
        throw std::runtime_error("cannot read EXR image: " + one_line(error.what()) + " (" +
                                 one_line(path) +
                                 "); save it again as whole scanline or tiled EXR in full "
                                 "resolution");
    }
}

}  // namespace midway
