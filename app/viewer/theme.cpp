#include "viewer/theme.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "viewer/gallery.h"
#include "viewer/panels/panels.h"

namespace midway {
namespace {

struct FontFiles {
    const char* regular;
    const char* heading;
};

constexpr std::array<FontFiles, 4> known_fonts = {{
    {"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
     "/usr/share/fonts/opentype/inter/Inter-SemiBold.otf"},
    {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
     "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"},
    {"/usr/share/fonts/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu/DejaVuSans-Bold.ttf"},
    {"/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
     "/usr/share/fonts/truetype/noto/NotoSans-Bold.ttf"},
}};

// Latin, Greek and Cyrillic, for names of files and objects, and the signs that panels use.
constexpr ImWchar glyphs[] = {0x20,   0x24F,  0x370,  0x52F,  0x2010, 0x2044, 0x2070,
                              0x209F, 0x2190, 0x2193, 0x2200, 0x226F, 0};

void load_fonts(float scale) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    ImFontConfig config;
    config.OversampleH = 2;
    config.OversampleV = 1;
    const float pixels = std::round(theme::font_points * scale);
    std::error_code none;
    for (const FontFiles& f : known_fonts) {
        if (!std::filesystem::is_regular_file(f.regular, none)) continue;
        if (!atlas.AddFontFromFileTTF(f.regular, pixels, &config, glyphs)) continue;
        if (std::filesystem::is_regular_file(f.heading, none))
            atlas.AddFontFromFileTTF(f.heading, pixels, &config);
        return;
    }
    config.SizePixels = std::round(13 * scale);
    atlas.AddFontDefault(&config);
}

void set_spacing(ImGuiStyle& s, float scale) {
    s = ImGuiStyle();
    s.WindowPadding = {10, 8};
    s.FramePadding = {7, 4};
    s.ItemSpacing = {7, 6};
    s.ItemInnerSpacing = {6, 4};
    s.IndentSpacing = 14;
    s.ScrollbarSize = 7;
    s.GrabMinSize = 9;
    s.WindowBorderSize = 0;
    s.PopupBorderSize = 1;
    s.FrameBorderSize = 0;
    s.WindowRounding = 0;
    s.ChildRounding = 3;
    s.PopupRounding = 4;
    s.FrameRounding = 3;
    s.GrabRounding = 2;
    s.ScrollbarRounding = 5;
    s.DisabledAlpha = 0.45f;
    s.WindowMenuButtonPosition = ImGuiDir_None;
    s.ScaleAllSizes(scale);
}

void set_colors(ImGuiStyle& s) {
    using theme::panel, theme::line, theme::rgb, theme::text, theme::text_dim;
    const auto set = [&](int which, const ImVec4& c) { s.Colors[which] = c; };
    for (int i = 0; i < ImGuiCol_COUNT; ++i) set(i, theme::frame);
    set(ImGuiCol_Text, text);
    set(ImGuiCol_TextDisabled, text_dim);
    set(ImGuiCol_WindowBg, panel);
    set(ImGuiCol_ChildBg, rgb(0, 0));
    set(ImGuiCol_PopupBg, rgb(0x1b1b1b, 0.98f));
    set(ImGuiCol_Border, line);
    set(ImGuiCol_BorderShadow, rgb(0, 0));
    set(ImGuiCol_FrameBg, theme::frame);
    set(ImGuiCol_FrameBgHovered, rgb(0x404040));
    set(ImGuiCol_FrameBgActive, rgb(0x484848));
    set(ImGuiCol_TitleBg, panel);
    set(ImGuiCol_TitleBgActive, panel);
    set(ImGuiCol_ScrollbarBg, rgb(0, 0));
    set(ImGuiCol_ScrollbarGrab, rgb(0x4a4a4a));
    set(ImGuiCol_ScrollbarGrabHovered, rgb(0x5a5a5a));
    set(ImGuiCol_ScrollbarGrabActive, rgb(0x6a6a6a));
    set(ImGuiCol_CheckMark, rgb(0xe6e6e6));
    set(ImGuiCol_SliderGrab, rgb(0x646464));
    set(ImGuiCol_SliderGrabActive, rgb(0x868686));
    set(ImGuiCol_Button, rgb(0x3d3d3d));
    set(ImGuiCol_ButtonHovered, rgb(0x4c4c4c));
    set(ImGuiCol_ButtonActive, rgb(0x5a5a5a));
    set(ImGuiCol_Header, rgb(0x2d2d2d));
    set(ImGuiCol_HeaderHovered, rgb(0x3a3a3a));
    set(ImGuiCol_HeaderActive, rgb(0x444444));
    set(ImGuiCol_Separator, line);
    set(ImGuiCol_PlotHistogram, rgb(0x8a8a8a));
    set(ImGuiCol_TextSelectedBg, rgb(0x5c6a72));
    set(ImGuiCol_DragDropTarget, text);
    set(ImGuiCol_NavHighlight, rgb(0x8a8a8a));
    set(ImGuiCol_ModalWindowDimBg, rgb(0, 0.55f));
    set(ImGuiCol_TableBorderLight, line);
    set(ImGuiCol_TableRowBg, rgb(0, 0));
}

}  // namespace

void apply_theme(float scale) {
    ImGuiStyle& style = ImGui::GetStyle();
    set_spacing(style, scale);
    set_colors(style);
    ImGui::GetIO().Fonts->Clear();
    const std::vector<GalleryEntry> gallery = read_gallery(assets_folder());
    reserve_thumbnails(gallery.size());
    load_fonts(scale);
    paint_thumbnails(gallery);
}

ImFont* theme::heading_font() {
    const ImVector<ImFont*>& fonts = ImGui::GetIO().Fonts->Fonts;
    return fonts.Size > 1 ? fonts[1] : fonts[0];
}

}  // namespace midway
