// The gallery: every scene that comes with Midway, with what to try.
#include "viewer/gallery.h"

#include <algorithm>
#include <cmath>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr float card_width = 12.4f, card_height = 16.2f;

void draw_thumbnail(size_t index, const ImVec2& at, const ImVec2& size) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const ImFontAtlasCustomRect& r = *atlas.GetCustomRectByIndex(static_cast<int>(index));
    if (!r.IsPacked()) return;
    ImVec2 low, high;
    atlas.CalcCustomRectUV(&r, &low, &high);
    // Half a texel inwards: the neighbours in the atlas must not show.
    const ImVec2 inset{0.5f * atlas.TexUvScale.x, 0.5f * atlas.TexUvScale.y};
    low = {low.x + inset.x, low.y + inset.y};
    high = {high.x - inset.x, high.y - inset.y};
    ImGui::GetWindowDrawList()->AddImage(atlas.TexID, at, {at.x + size.x, at.y + size.y}, low,
                                         high);
}

// True where it was chosen.
bool card(size_t index, const GalleryEntry& entry) {
    ImGui::PushID(static_cast<int>(index));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size{em(card_width), em(card_height)}, picture{size.x, size.x * 0.75f};
    const bool clicked = ImGui::InvisibleButton("card", size);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered()) {
        const float edge = em(0.35f);
        draw.AddRectFilled({at.x - edge, at.y - edge}, {at.x + size.x + edge, at.y + size.y + edge},
                           theme::color(theme::rgb(0x3a3a3a)), em(0.3f));
    }
    draw_thumbnail(index, at, picture);
    const float top = at.y + picture.y + em(0.35f);
    ImFont* heading = theme::heading_font();
    draw.AddText(heading, heading->FontSize, {at.x, top}, theme::color(theme::text),
                 entry.title.c_str());
    draw.AddText(ImGui::GetFont(), em(0.93f), {at.x, top + em(1.3f)}, theme::color(theme::text_dim),
                 entry.what_to_try.c_str(), nullptr, size.x);
    ImGui::PopID();
    return clicked;
}

}  // namespace

Change draw_gallery(App& app) {
    if (!app.ui.gallery || app.ui.keys) return {};
    PanelState& state = app.ui.panel;
    if (!state.gallery) state.gallery = read_gallery(assets_folder());
    ui::begin_sheet("##gallery", app.ui.gallery);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {em(1), em(0.9f)});
    ImGui::PushFont(theme::heading_font());
    ImGui::TextUnformatted("Scenes to try");
    ImGui::PopFont();
    const std::vector<GalleryEntry>& entries = *state.gallery;
    if (entries.empty()) ImGui::TextUnformatted("The folder assets/ is not beside this program.");
    const int columns = std::clamp(
        static_cast<int>((ImGui::GetIO().DisplaySize.x - em(5)) / em(card_width + 1)), 1, 4);
    for (size_t i = 0; i < entries.size(); ++i) {
        if (i % static_cast<size_t>(columns) != 0) ImGui::SameLine();
        if (card(i, entries[i])) {
            ask(app, ActionKind::open, entries[i].scene.string());
            app.ui.gallery = false;
        }
    }
    if (ImGui::Button("Close")) app.ui.gallery = false;
    ImGui::PopStyleVar();
    ui::end_sheet();
    return {};
}

}  // namespace midway
