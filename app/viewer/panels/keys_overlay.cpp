// F1: every key and what the mouse does.
#include <algorithm>
#include <string_view>

#include "viewer/keys.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

void line(const char* key, const char* what) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(key);
    ImGui::TableNextColumn();
    ImGui::TextColored(theme::text_dim, "%s", what);
}

void headline(const char* text) {
    ImGui::Dummy({0, em(0.3f)});
    ImGui::PushFont(theme::heading_font());
    ImGui::TextUnformatted(text);
    ImGui::PopFont();
}

bool begin_lines(const char* id, float keys) {
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX))
        return false;
    ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed, em(keys));
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed, em(12.5f));
    return true;
}

void draw_group(std::string_view group) {
    headline(group.data());
    if (!begin_lines(group.data(), 6.2f)) return;
    for (const KeyBinding& b : key_bindings())
        if (b.group == group && *b.what) line(b.shown, b.what);
    ImGui::EndTable();
}

// The groups of the table whose number is even, or odd.
void draw_groups(int parity) {
    std::string_view group;
    int number = -1;
    for (const KeyBinding& b : key_bindings()) {
        if (b.group == group) continue;
        group = b.group;
        if (++number % 2 == parity) draw_group(group);
    }
}

void draw_mouse(App& app) {
    headline("Mouse");
    if (begin_lines("mouse", 10.6f)) {
        for (const MouseHint& h : mouse_hints()) line(h.gesture, h.what);
        ImGui::EndTable();
    }
    ImGui::Dummy({0, em(1)});
    if (ImGui::Button("Show the tour")) {
        app.ui.keys = false;
        app.ui.tour_step = 0;
    }
    ImGui::SameLine();
    if (ImGui::Button("Close")) app.ui.keys = false;
}

}  // namespace

Change draw_keys(App& app) {
    const Change change = handle_keys(app);
    if (!app.ui.keys) return change;
    ui::begin_sheet("##keys", app.ui.keys);
    // Smaller where the window is too narrow for all three columns.
    const float needed = em(68);
    ImGui::SetWindowFontScale(std::clamp(ImGui::GetIO().DisplaySize.x / needed, 0.6f, 1.0f));
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {em(0.2f), em(0.08f)});
    for (int column = 0; column < 3; ++column) {
        if (column > 0) ImGui::SameLine(0, em(1.2f));
        ImGui::BeginGroup();
        column < 2 ? draw_groups(column) : draw_mouse(app);
        ImGui::EndGroup();
    }
    ImGui::PopStyleVar();
    ImGui::SetWindowFontScale(1);
    ui::end_sheet();
    return change;
}

}  // namespace midway
