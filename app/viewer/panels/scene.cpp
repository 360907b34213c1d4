// What is in the file, its sky and lamps, and what the file left out or had mended.
#include <fmt/format.h>
#include <imgui.h>
// After imgui.h.
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

std::string counted(size_t n, const char* one, const char* many) {
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string contents(const PreparedScene& p) {
    const Geometry& g = *p.scene->geometry;
    size_t emissive = 0, lamps = 0;
    for (const Light& l : p.scene->lights) {
        emissive += l.kind == LightKind::area;
        lamps += is_delta(l.kind);
    }
    std::string text =
        fmt::format("{}, {}, {}", counted(g.triangle_count, "triangle", "triangles"),
                    counted(g.objects.size(), "object", "objects"),
                    counted(p.description.materials.size(), "material", "materials"));
    if (emissive > 0) text += ", " + counted(emissive, "triangle", "triangles") + " that shine";
    if (lamps > 0) text += ", " + counted(lamps, "lamp", "lamps") + " without size";
    return text;
}

// The colour that was asked for last, or the sky's own; none where it is a map.
std::optional<vec3> sky_color(const App& app) {
    vec3 c;
    const std::optional<std::string>& asked = app.document.options.sky;
    if (asked && std::sscanf(asked->c_str(), "%f,%f,%f", &c.x, &c.y, &c.z) == 3) return c;
    const auto& sky = app.document.prepared->description.sky;
    if (asked || !sky || sky->map) return {};
    return sky->color;
}

std::string sky_in_words(const App& app) {
    const PreparedScene& p = *app.document.prepared;
    if (p.default_sky) return "soft default sky";
    if (!p.description.sky) return "none: black";
    const SkyDescription& sky = *p.description.sky;
    if (!sky.map) return "one colour";
    return std::filesystem::path(sky.source).filename().string();
}

Change draw_sky_source(App& app) {
    const PreparedScene& p = *app.document.prepared;
    FileFields& f = app.ui.panel.files;
    ui::row("Sky",
            "Light from infinitely far around the scene. Drop an .hdr or .exr on the window, "
            "or name one here.");
    const float button = app.document.options.sky ? ui::em(3.6f) : 0;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(
        ui::fitted(sky_in_words(app), ImGui::GetContentRegionAvail().x - button).c_str());
    if (p.description.sky) ui::tip(p.description.sky->source.c_str());
    if (app.document.options.sky) {
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ui::em(3));
        if (ui::wide_button("File's", "Back to what the file says", -1))
            ask(app, ActionKind::set_sky);
    }
    if (p.default_sky)
        ui::note(
            theme::light,
            "The file has no light, so a soft default sky shines. Choose a sky to replace it.");
    ui::row("  Map", "An equirectangular map, .hdr or .exr. Enter uses it.");
    ImGui::SetNextItemWidth(-ui::em(3.6f));
    const bool entered = ImGui::InputTextWithHint("##sky path", "path of .hdr or .exr", &f.sky_path,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if ((ui::wide_button("Use", "Uses this map as the sky", -1) || entered) && !f.sky_path.empty())
        ask(app, ActionKind::set_sky, f.sky_path);
    ui::row("  Colour", "The same light from everywhere. The numbers are radiance.");
    vec3 color = sky_color(app).value_or(vec3(0));
    if (ImGui::ColorEdit3("##sky colour", &color.x,
                          ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR) &&
        is_finite(color) && color.x >= 0 && color.y >= 0 && color.z >= 0)
        ask(app, ActionKind::set_sky, fmt::format("{},{},{}", color.x, color.y, color.z));
    return {};
}

Change draw_strengths(App& app) {
    Change change;
    SceneOptions& o = app.document.options;
    if (app.document.prepared->description.sky) {
        ui::row("  Rotation",
                "Of the sky about the vertical axis, in degrees, counter-clockwise seen "
                "from above.");
        double degrees = o.sky_rotation_degrees;
        constexpr double low = -180, high = 180;
        if (ImGui::SliderScalar("##rotation", ImGuiDataType_Double, &degrees, &low, &high,
                                "%.1f") &&
            std::isfinite(degrees)) {
            o.sky_rotation_degrees = degrees;
            change.scene = true;
        }
        ui::row("  Strength", "Factor on the sky's light.");
        double strength = o.sky_strength;
        if (ui::drag_number("##sky strength", strength, 0, 1e6, "%.4g")) {
            o.sky_strength = static_cast<float>(strength);
            change.scene = true;
        }
    }
    ui::row("Lamps", "Factor on every light but the sky.");
    double lamps = o.lamp_strength;
    if (ui::drag_number("##lamps", lamps, 0, 1e6, "%.4g")) {
        o.lamp_strength = static_cast<float>(lamps);
        change.scene = true;
    }
    return change;
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
        ui::wrapped(theme::text_dim, contents(*d.prepared));
        change |= draw_sky_source(app);
        change |= draw_strengths(app);
        if (!d.warnings.empty() &&
            ImGui::TreeNode(
                "warnings", "%s",
                counted(d.warnings.size(), "line about this file", "lines about this file")
                    .c_str())) {
            for (const std::string& w : d.warnings) ui::note(theme::light, w);
            ImGui::TreePop();
        }
    } else {
        ui::wrapped(theme::text_dim, "No scene is open. Drop a .gltf or .glb file on the window.");
    }
    ui::end_section(app);
    return change;
}

}  // namespace midway
