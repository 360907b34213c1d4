// The scenes that come with Midway (assets/gallery.json): a picture and one sentence each on what
// to try. Reading throws nothing: a folder that is missing or broken makes an empty gallery.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace midway {

struct GalleryEntry {
    std::string title;
    std::string what_to_try;          // one sentence
    std::filesystem::path scene;      // .glb or .midway
    std::filesystem::path thumbnail;  // 4:3
};

// assets/ beside the program's build or installation, or where it was built; empty where there is
// none.
std::filesystem::path assets_folder();

std::vector<GalleryEntry> read_gallery(const std::filesystem::path& assets);

inline constexpr int thumbnail_width = 256, thumbnail_height = 192;

// Reserves room for the thumbnails in ImGui's atlas, before it is built: entry i has custom
// rectangle i. Then, once it is built, fills it; grey where a picture cannot be read.
void reserve_thumbnails(size_t count);
void paint_thumbnails(const std::vector<GalleryEntry>& entries);

}  // namespace midway
