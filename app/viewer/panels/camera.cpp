// Where the camera is, its lens, and views to come back to.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

// What `--camera` calls it: its name where that is its alone.
std::string option_of(const std::vector<CameraDescription>& cameras, size_t index) {
    const std::string& name = cameras[index].name;
    const auto namesakes = std::count_if(cameras.begin(), cameras.end(),
                                         [&](const auto& c) { return c.name == name; });
    return name.empty() || namesakes > 1 ? std::to_string(index) : name;
}

std::string title_of(const CameraDescription& c, size_t index) {
    return c.name.empty() ? fmt::format("Camera {}", index) : c.name;
}

Change use_camera_of_file(App& app, std::optional<std::string> option) {
    SceneOptions& o = app.document.options;
    o.camera = std::move(option);
    o.look_at.reset();
    o.fov_degrees.reset();
    o.aperture_radius.reset();
    o.focus_distance.reset();
    app.ui.panel.navigation.pivot_of = nullptr;
    return {.camera = true};
}

Change draw_cameras(App& app) {
    Change change;
    const auto& cameras = app.document.prepared->description.cameras;
    const SceneOptions& o = app.document.options;
    ui::row("Camera", "Cameras of the file. Moving by hand starts from the one chosen.");
    std::string shown = cameras.empty() ? "The whole scene" : title_of(cameras[0], 0);
    for (size_t i = 0; i < cameras.size(); ++i)
        if (o.camera && *o.camera == option_of(cameras, i)) shown = title_of(cameras[i], i);
    if (o.look_at) shown = "By hand, from " + shown;
    if (!ImGui::BeginCombo("##camera", shown.c_str())) return change;
    if (cameras.empty() && ImGui::Selectable("The whole scene", !o.look_at))
        change |= use_camera_of_file(app, {});
    for (size_t i = 0; i < cameras.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable(title_of(cameras[i], i).c_str(), false))
            change |= use_camera_of_file(app, option_of(cameras, i));
        ImGui::PopID();
    }
    ImGui::EndCombo();
    return change;
}

Change draw_lens(App& app) {
    Change change;
    SceneOptions& o = app.document.options;
    const CameraDescription& camera = app.document.prepared->camera;
    const double radius = scene_radius(*app.document.prepared->scene);
    ui::row("Field of view", "Vertical angle, in degrees.");
    double fov = o.fov_degrees.value_or(glm::degrees(camera.yfov));
    constexpr double narrow = 1, wide = 150;
    if (ImGui::SliderScalar("##fov", ImGuiDataType_Double, &fov, &narrow, &wide, "%.1f",
                            ImGuiSliderFlags_NoRoundToFormat) &&
        fov > 0.1 && fov < 179) {
        o.fov_degrees = fov;
        change.camera = true;
    }
    ui::row("Aperture",
            "Radius of the thin lens, in the scene's units. 0: a pinhole, all is sharp.");
    double aperture = o.aperture_radius.value_or(camera.aperture_radius);
    if (ImGui::DragScalar("##aperture", ImGuiDataType_Double, &aperture,
                          static_cast<float>(radius * 2e-4), nullptr, nullptr,
                          aperture > 0 ? "%.4g" : "0 (pinhole)") &&
        std::isfinite(aperture)) {
        o.aperture_radius = std::clamp(aperture, 0.0, radius);
        change.camera = true;
    }
    ui::row("Focus", "Distance along the view axis at which all is sharp.");
    double focus = o.focus_distance.value_or(camera.focus_distance);
    ImGui::SetNextItemWidth(-ui::em(4.2f));
    if (ImGui::DragScalar("##focus", ImGuiDataType_Double, &focus,
                          static_cast<float>(radius * 2e-3), nullptr, nullptr,
                          focus > 0 ? "%.4g" : "automatic") &&
        std::isfinite(focus)) {
        o.focus_distance = std::max(0.0, focus);
        change.camera = true;
    }
    ImGui::SameLine();
    const bool picking = app.ui.panel.navigation.tool == ViewTool::focus;
    if (ui::wide_button(picking ? "Click..." : "Pick",
                        "Then click the point that shall be sharp; opens a pinhole a little. [L]",
                        -1))
        choose_tool(app, ViewTool::focus);
    return change;
}

Change draw_bookmarks(App& app) {
    Change change;
    auto& bookmarks = app.camera.bookmarks;
    std::optional<size_t> removed;
    for (size_t i = 0; i < bookmarks.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const float cross = ImGui::GetFrameHeight();
        if (ui::wide_button(bookmarks[i].name.c_str(), "Go back to this view. [J: the next one]",
                            -cross - ImGui::GetStyle().ItemSpacing.x))
            change |= recall_bookmark(app, static_cast<int>(i));
        ImGui::SameLine();
        if (ui::wide_button("x", "Forget this view", cross)) removed = i;
        ImGui::PopID();
    }
    if (removed) bookmarks.erase(bookmarks.begin() + static_cast<std::ptrdiff_t>(*removed));
    return change;
}

}  // namespace

Change store_bookmark(App& app) {
    if (!app.document.prepared) return {};
    auto& bookmarks = app.camera.bookmarks;
    bookmarks.push_back({fmt::format("View {}", bookmarks.size() + 1), current_view(app)});
    app.ui.panel.navigation.bookmark = static_cast<int>(bookmarks.size()) - 1;
    notify(app, "stored " + bookmarks.back().name, ImGui::GetTime());
    return {};
}

Change recall_bookmark(App& app, int index) {
    const auto& bookmarks = app.camera.bookmarks;
    if (!app.document.prepared || bookmarks.empty()) return {};
    Navigation& n = app.ui.panel.navigation;
    n.bookmark = index % static_cast<int>(bookmarks.size());
    const View& to = bookmarks[static_cast<size_t>(n.bookmark)].view;
    n.to = ViewGlide{current_view(app), to, 0};
    app.camera.pivot = to.target;
    app.camera.animating = true;
    return {};
}

Change draw_camera(App& app) {
    if (!ui::begin_section(app, ui::Side::left, "Camera", true)) return {};
    Change change;
    if (app.document.prepared) {
        change |= draw_cameras(app);
        change |= draw_lens(app);
        const float half = ui::share_of_width(2);
        if (ui::wide_button("Frame scene", "Moves until the whole scene is in view. [F] or [Home]",
                            half))
            change |= frame_whole_scene(app);
        ImGui::SameLine();
        if (ui::wide_button("Store view", "Keeps this view to come back to. [K]", half))
            change |= store_bookmark(app);
        change |= draw_bookmarks(app);
    } else {
        ui::wrapped(theme::text_dim, "No scene is open.");
    }
    ui::end_section(app);
    return change;
}

}  // namespace midway
