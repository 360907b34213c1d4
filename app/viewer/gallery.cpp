#include "viewer/gallery.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/picture.h"

namespace midway {
namespace fs = std::filesystem;
namespace {

// A plain file name: entries of the list must not leave its folder.
bool is_plain(const std::string& name) {
    return !name.empty() && fs::path(name).filename() == fs::path(name) && name != "..";
}

// Where a custom rectangle's pixels begin in the atlas, and the length of the atlas's rows.
struct AtlasPlace {
    unsigned char* pixels = nullptr;
    size_t row = 0;
};

void fill_grey(const AtlasPlace& place) {
    for (int y = 0; y < thumbnail_height; ++y)
        for (int x = 0; x < thumbnail_width; ++x) {
            constexpr std::array<unsigned char, 4> grey{60, 60, 60, 255};
            std::copy(grey.begin(), grey.end(), place.pixels + y * place.row + x * 4);
        }
}

// Nearest pixels; thumbnails have the right size already.
void fill(const AtlasPlace& place, const Picture& picture) {
    for (int y = 0; y < thumbnail_height; ++y)
        for (int x = 0; x < thumbnail_width; ++x) {
            const int from_x = x * picture.width / thumbnail_width;
            const int from_y = y * picture.height / thumbnail_height;
            const size_t from = (static_cast<size_t>(from_y) * picture.width + from_x) * 4;
            std::memcpy(place.pixels + y * place.row + x * 4, picture.rgba.data() + from, 4);
        }
}

}  // namespace

fs::path assets_folder() {
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
    for (const fs::path& folder : {program / "../../../assets", program / "../share/midway/assets",
                                   fs::path(MIDWAY_ASSETS_FOLDER)})
        if (fs::is_regular_file(folder / "gallery.json", none))
            return fs::weakly_canonical(folder, none);
    return {};
}

std::vector<GalleryEntry> read_gallery(const fs::path& assets) {
    std::vector<GalleryEntry> entries;
    try {
        std::ifstream file(assets / "gallery.json");
        const nlohmann::json list = nlohmann::json::parse(file);
        for (const auto& scene : list.at("scenes")) {
            const std::string name = scene.at("file"), picture = scene.at("thumbnail");
            if (!is_plain(name) || !is_plain(picture)) continue;
            entries.push_back(
                {scene.at("title"), scene.at("try"), assets / name, assets / "pictures" / picture});
        }
    } catch (const std::exception&) {
        // No gallery, or half of one.
    }
    return entries;
}

void reserve_thumbnails(size_t count) {
    for (size_t i = 0; i < count; ++i)
        ImGui::GetIO().Fonts->AddCustomRectRegular(thumbnail_width, thumbnail_height);
}

void paint_thumbnails(const std::vector<GalleryEntry>& entries) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    for (size_t i = 0; i < entries.size(); ++i) {
        const ImFontAtlasCustomRect& r = *atlas.GetCustomRectByIndex(static_cast<int>(i));
        if (!r.IsPacked()) continue;
        const size_t row = static_cast<size_t>(width) * 4;
        const AtlasPlace place{pixels + r.Y * row + r.X * 4, row};
        try {
            fill(place, read_picture(entries[i].thumbnail.string()));
        } catch (const std::exception&) {
            fill_grey(place);
        }
    }
}

}  // namespace midway
