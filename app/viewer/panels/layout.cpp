// Two columns that collapse, a status line below, and the image in what is left.
#include <algorithm>
#include <cmath>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav;

struct Columns {
    float left = 0, right = 0, bottom = 0;  // sizes in points
    float dock = 0;                         // above the status line, as wide as the window
    float pyramid = 0;                      // between the image and the right one
};

// Beside the image; the right column gives way where that leaves both too little.
void make_room_for_pyramid(const App& app, const ImVec2& size, Columns& c) {
    if (!app.display.pyramid.open) return;
    const float least = em(22), pleasant = em(80);
    if (size.x - c.left - c.right < pleasant) c.right = 0;
    const float room = size.x - c.left - c.right;
    const float wish = room * app.ui.panel.pyramid.share;
    c.pyramid = std::round(std::clamp(wish, std::min(least, room), std::max(room - em(10), least)));
}

Columns columns_of(const App& app, const ImVec2& size) {
    if (!app.ui.panels) {
        Columns c;
        make_room_for_pyramid(app, size, c);
        return c;
    }
    const Arrangement& a = app.ui.panel.arrangement;
    const float width = std::round(em(19));
    Columns c;
    c.bottom = std::round(ImGui::GetFrameHeight() + em(0.3f));
    if (app.ui.panel.navigation.tool == ViewTool::inspect)
        c.dock = std::round(std::min(em(16), 0.4f * size.y));
    c.left = a.left ? width : 0;
    c.right = a.right ? width : 0;
    // Where both would leave the image too little, everything moves to the left one.
    if (c.left > 0 && size.x - c.left - c.right < em(14)) c.right = 0;
    make_room_for_pyramid(app, size, c);
    return c;
}

void column(const char* name, float x, float width, float height) {
    ImGui::SetNextWindowPos({x, 0});
    ImGui::SetNextWindowSize({width, height});
    // The scroll bar comes and goes in the right padding: nothing may jump when it does.
    ImGui::SetNextWindowContentSize({width - 2 * ImGui::GetStyle().WindowPadding.x - em(0.25f), 0});
    ImGui::Begin(name, nullptr, fixed);
    ImGui::End();
}

// A handle at the edge between a column and the image: click to fold the column away.
void fold_handle(const char* id, bool& open, float edge, bool points_left, float height) {
    const ImVec2 size{em(0.9f), em(3.2f)};
    ImGui::SetNextWindowPos({points_left ? edge : edge - size.x, (height - size.y) / 2});
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin(id, nullptr, fixed | ImGuiWindowFlags_NoBackground);
    ImGui::PopStyleVar(2);
    if (ImGui::InvisibleButton("fold", size)) open = !open;
    const bool hovered = ImGui::IsItemHovered();
    ui::tip(open ? "Fold this column away (Tab hides all panels)" : "Unfold this column");
    const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(a, b, theme::color(theme::panel, hovered ? 1.0f : 0.75f), em(0.25f));
    const float cx = (a.x + b.x) / 2, cy = (a.y + b.y) / 2;
    const float r = em(0.25f), way = points_left == open ? -1.0f : 1.0f;
    const ImU32 color = theme::color(hovered ? theme::text : theme::text_dim);
    draw.AddTriangleFilled({cx + way * r, cy}, {cx - way * r, cy - 1.6f * r},
                           {cx - way * r, cy + 1.6f * r}, color);
    ImGui::End();
}

}  // namespace

Change draw_layout(App& app) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Columns c = columns_of(app, size);
    Arrangement& a = app.ui.panel.arrangement;
    a.right_fits = c.right > 0;
    const float height = size.y - c.bottom - c.dock;
    app.ui.view = {{c.left, 0}, {size.x - c.right - c.pyramid, height}};
    app.ui.panel.dock = {0, height, size.x, height + c.dock};
    app.ui.panel.pyramid.place = {size.x - c.right - c.pyramid, 0, size.x - c.right, height};
    if (app.ui.panels) {
        if (c.left > 0) column("##left", 0, c.left, height);
        if (c.right > 0) column("##right", size.x - c.right, c.right, height);
        fold_handle("##fold left", a.left, c.left, true, height);
        if (c.right > 0 || !a.right)
            fold_handle("##fold right", a.right, size.x - c.right, false, height);
    }
    const ImGuiIO& io = ImGui::GetIO();
    app.ui.view_hovered =
        !io.WantCaptureMouse && app.ui.view.contains({io.MousePos.x, io.MousePos.y});
    return {};
}

}  // namespace midway
