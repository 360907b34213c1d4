// Opening, saving, and the command line that makes the same image.
#include <fmt/format.h>
#include <imgui.h>
// After imgui.h.
#include <imgui_stdlib.h>

#include <filesystem>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

void draw_open(App& app) {
    FileFields& f = app.ui.panel.files;
    if (f.focus_open) {
        ImGui::SetKeyboardFocusHere();
        f.focus_open = false;
    }
    ImGui::SetNextItemWidth(-ui::em(4.2f));
    const bool entered =
        ImGui::InputTextWithHint("##open", "path of .gltf, .glb, .midway", &f.open_path,
                                 ImGuiInputTextFlags_EnterReturnsTrue);
    ui::tip(
        "Or drop a file on the window: scenes and sessions open, .hdr and .exr become the sky.");
    ImGui::SameLine();
    if ((ui::wide_button("Open", "Opens this file; the one in view stays if it is broken. [Ctrl+O]",
                         -1) ||
         entered) &&
        !f.open_path.empty())
        ask(app, ActionKind::open, f.open_path);
    const float third = ui::share_of_width(3);
    if (ui::wide_button("Gallery", "Scenes that come with Midway, and what to try with each. [G]",
                        third))
        app.ui.gallery = true;
    ImGui::SameLine();
    if (ui::wide_button("Recent", "Files opened before", third)) ImGui::OpenPopup("recent");
    ImGui::SameLine();
    ImGui::BeginDisabled(app.document.path.empty());
    if (ui::wide_button("Reload",
                        "Reads the file again; camera and edits stay. It also happens by "
                        "itself when the file changes. [F5]",
                        third))
        ask(app, ActionKind::reload);
    ImGui::EndDisabled();
    if (ImGui::BeginPopup("recent")) {
        if (app.ui.recent.empty()) ImGui::TextDisabled("none yet");
        for (const std::string& path : app.ui.recent)
            if (ImGui::MenuItem(ui::fitted(path, ui::em(34)).c_str()))
                ask(app, ActionKind::open, path);
        ImGui::EndPopup();
    }
}

void draw_save(App& app) {
    FileFields& f = app.ui.panel.files;
    if (f.save_name_for != app.document.path) {
        f.save_name = std::filesystem::path(app.document.path).stem().string();
        f.save_name_for = app.document.path;
    }
    ui::row("Save as",
            "Name without extension; a folder before it is allowed. Nothing is "
            "overwritten: where a file exists, a number is added.");
    ImGui::InputText("##save", &f.save_name);
    ImGui::BeginDisabled(f.save_name.empty() || !app.document.prepared);
    const float third = ui::share_of_width(3);
    if (ui::wide_button("EXR",
                        "Linear light with the settings in its header, the very bits of "
                        "midway render. [Ctrl+S]",
                        third))
        ask(app, ActionKind::save_image, free_name(f.save_name, ".exr"));
    ImGui::SameLine();
    if (ui::wide_button("PNG", "As it is seen: exposure, tone curve, channel. [Ctrl+P]", third))
        ask(app, ActionKind::save_image, free_name(f.save_name, ".png"));
    ImGui::SameLine();
    if (ui::wide_button("Session",
                        "A .midway file: the scene's path with camera, edits, settings and "
                        "bookmarks. [Ctrl+Shift+S]",
                        third))
        ask(app, ActionKind::save_session, free_name(f.save_name, ".midway"));
    if (ui::wide_button(
            "Copy as command line",
            "The exact midway render that makes the same bits, into the clipboard; after "
            "an edit through a session file. [Ctrl+C]",
            -1))
        ask(app, ActionKind::copy_command_line);
    ImGui::EndDisabled();
}

}  // namespace

std::string free_name(const std::string& stem, const std::string& extension) {
    std::error_code none;
    std::string name = stem + extension;
    for (int i = 2; std::filesystem::exists(name, none) && i < 10000; ++i)
        name = fmt::format("{}-{}{}", stem, i, extension);
    return name;
}

Change draw_files(App& app) {
    if (!ui::begin_section(app, ui::Side::right, "Files", true)) return {};
    draw_open(app);
    draw_save(app);
    ui::end_section(app);
    return {};
}

}  // namespace midway
