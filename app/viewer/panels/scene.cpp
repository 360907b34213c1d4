// What is in the file, what was changed about it, and what the file left out or had mended.
#include <fmt/format.h>
#include <imgui.h>

#include <filesystem>

#include "viewer/edits.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

std::string counted(size_t n, const char* one, const char* many) {
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

// One line, whatever is edited: nothing below may jump when a lamp is switched.
std::string contents(const PreparedScene& p) {
    const Geometry& g = *p.scene->geometry;
    return fmt::format("{}, {}, {}", counted(g.triangle_count, "triangle", "triangles"),
                       counted(g.objects.size(), "object", "objects"),
                       counted(p.description.materials.size(), "material", "materials"));
}

// What was changed, and the way back.
Change draw_changes(App& app) {
    Change change;
    const float width = ui::share_of_width(3);
    ImGui::BeginDisabled(app.undo.past.empty());
    if (ui::wide_button("Undo", "Takes back the last change of sky, lamps or materials. [Ctrl+Z]",
                        width))
        change |= undo_edit(app);
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(app.undo.future.empty());
    if (ui::wide_button("Redo", "Makes the change again that was taken back. [Ctrl+Shift+Z]",
                        width))
        change |= redo_edit(app);
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!is_edited(app));
    if (ui::wide_button("Reset all",
                        "Sky, lamps and materials as the file has them; the camera stays. Undo "
                        "brings the changes back.",
                        width))
        change |= reset_scene(app);
    ImGui::EndDisabled();
    return change;
}

// Work that this scene spares the renderer. The image is the same with it.
void draw_left_out(const std::vector<std::string>& lines) {
    if (lines.empty()) {
        ImGui::TextColored(theme::text_dim, "Everything is needed here");
        return;
    }
    const bool open = ImGui::TreeNode(
        "left out", "%s", (counted(lines.size(), "thing", "things") + " not needed here").c_str());
    ui::tip(
        "Work that nothing in this scene asks for, found when it was loaded and left out of every "
        "sample. The image does not change by it. midway info --cost measures what each saves.");
    if (!open) return;
    for (const std::string& line : lines) ui::wrapped(theme::text_dim, line);
    ImGui::TreePop();
}

}  // namespace

Change draw_scene(App& app) {
    if (!ui::begin_section(app, ui::Side::right, "Scene", true)) return {};
    Change change;
    const Document& d = app.document;
    if (d.prepared) {
        const std::string name = std::filesystem::path(d.path).filename().string();
        ImGui::TextUnformatted(ui::fitted(name, ImGui::GetContentRegionAvail().x).c_str());
        ui::tip(d.path.c_str());
        const std::string text = contents(*d.prepared);
        ImGui::TextColored(theme::text_dim, "%s",
                           ui::fitted(text, ImGui::GetContentRegionAvail().x).c_str());
        ui::tip(text.c_str());
        change |= draw_changes(app);
        if (!d.warnings.empty() &&
            ImGui::TreeNode(
                "warnings", "%s",
                counted(d.warnings.size(), "line about this file", "lines about this file")
                    .c_str())) {
            for (const std::string& w : d.warnings) ui::note(theme::light, w);
            ImGui::TreePop();
        }
        draw_left_out(d.left_out);
    } else {
        ui::wrapped(theme::text_dim, "No scene is open. Drop a .gltf or .glb file on the window.");
    }
    ui::end_section(app);
    return change;
}

}  // namespace midway
