// F1: every key and what the mouse does.
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
    ImGui::TableNextRow(0, ImGui::GetTextLineHeight() * 1.7f);
    ImGui::TableNextColumn();
    ImGui::Dummy({0, em(0.3f)});
    ImGui::PushFont(theme::heading_font());
    ImGui::TextUnformatted(text);
    ImGui::PopFont();
    ImGui::TableNextColumn();
}

bool begin_columns(const char* id, float keys, float words) {
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX))
        return false;
    ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed, em(keys));
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed, em(words));
    return true;
}

// The groups of the table whose number is even, or odd.
void groups(int parity) {
    std::string_view group;
    int number = -1;
    for (const KeyBinding& b : key_bindings()) {
        if (b.group != group) {
            group = b.group;
            if (++number % 2 == parity) headline(b.group);
        }
        if (number % 2 == parity && *b.what) line(b.shown, b.what);
    }
}

}  // namespace

Change draw_keys(App& app) {
    const Change change = handle_keys(app);
    if (!app.ui.keys) return change;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowFocus();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {em(1.2f), em(0.8f)});
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {em(0.3f), em(0.08f)});
    ImGui::Begin("##keys", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::BeginGroup();
    if (begin_columns("first", 6.5f, 13)) {
        groups(0);
        ImGui::EndTable();
    }
    ImGui::EndGroup();
    ImGui::SameLine(0, em(1.5f));
    ImGui::BeginGroup();
    if (begin_columns("second", 6.5f, 12)) {
        groups(1);
        ImGui::EndTable();
    }
    ImGui::EndGroup();
    ImGui::SameLine(0, em(1.5f));
    ImGui::BeginGroup();
    if (begin_columns("mouse", 10.5f, 13)) {
        headline("Mouse");
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
    ImGui::EndGroup();
    ImGui::End();
    ImGui::PopStyleVar(2);
    return change;
}

}  // namespace midway
