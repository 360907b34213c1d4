// Everything that shines: a list with a switch, a colour and a strength for each, the details of
// the one selected below it.
#include <fmt/format.h>
#include <imgui.h>
// After imgui.h.
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "viewer/panels/edit_widgets.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr size_t rows_in_sight = 7;

// Colour and strength of a lamp as they are edited, and the file's.
struct Shine {
    vec3 color{1};
    float strength = 1;
};

Shine shine_of(const App& app, const Lamp& lamp) {
    const PreparedScene& p = *app.document.prepared;
    const SceneOptions& o = app.document.options;
    if (lamp.kind == LampKind::sky)
        return {o.edits.sky.color.value_or(p.sky->color), o.sky_strength};
    const size_t k = static_cast<size_t>(lamp.index);
    if (lamp.kind == LampKind::light) {
        const PunctualLight l = values_of(p.file->lights[k], light_edit(app, lamp.index));
        return {l.color, l.intensity};
    }
    const MaterialEdit e = material_edit(app, lamp.index);
    const EmissionParts parts = emission_parts(p.file->materials[k]);
    return {e.emission_color.value_or(parts.color), e.emission_strength.value_or(parts.strength)};
}

Change set_shine(App& app, const Lamp& lamp, const Shine& before, const Shine& now) {
    if (lamp.kind == LampKind::sky) {
        app.document.options.sky_strength = now.strength;
        SkyEdit e = app.document.options.edits.sky;
        if (now.color != before.color) e.color = now.color;
        return change_sky(app, e);
    }
    if (lamp.kind == LampKind::light) {
        LightEdit e = light_edit(app, lamp.index);
        if (now.color != before.color) e.color = now.color;
        if (now.strength != before.strength) e.strength = now.strength;
        return change_light(app, lamp.index, std::move(e));
    }
    MaterialEdit e = material_edit(app, lamp.index);
    if (now.color != before.color) e.emission_color = now.color;
    if (now.strength != before.strength) e.emission_strength = now.strength;
    return change_material(app, lamp.index, std::move(e));
}

bool is_changed(const App& app, const Lamp& lamp) {
    const SceneOptions& o = app.document.options;
    if (lamp.kind == LampKind::sky)
        return o.edits.sky != SkyEdit{} || o.sky_strength != 1 || o.sky_rotation_degrees != 0;
    if (lamp.kind == LampKind::light) {
        const LightEdit e = light_edit(app, lamp.index);
        return e != LightEdit{.name = e.name, .index = e.index};
    }
    const MaterialEdit e = material_edit(app, lamp.index);
    return !e.on || e.emission_color || e.emission_strength;
}

Change reset_lamp(App& app, const Lamp& lamp) {
    if (lamp.kind == LampKind::sky) {
        app.document.options.sky_strength = 1;
        app.document.options.sky_rotation_degrees = 0;
        return change_sky(app, {});
    }
    if (lamp.kind == LampKind::light) return change_light(app, lamp.index, {});
    MaterialEdit e = material_edit(app, lamp.index);
    e.on = true;
    e.emission_color.reset();
    e.emission_strength.reset();
    return change_material(app, lamp.index, std::move(e));
}

const char* strength_tip(ui::LampSign sign) {
    switch (sign) {
        case ui::LampSign::point:
        case ui::LampSign::spot:
            return "Radiant intensity, per steradian. Drag, or Ctrl+click to type.";
        case ui::LampSign::directional:
            return "Irradiance of a surface that faces the light. Drag, or Ctrl+click to type.";
        case ui::LampSign::area:
            return "Radiance of its surface. Drag, or Ctrl+click to type.";
        case ui::LampSign::sky:
            break;
    }
    return "Factor on the sky's light. Drag, or Ctrl+click to type.";
}

Change draw_row(App& app, const Lamp& lamp) {
    Change change;
    Selection& s = app.ui.panel.selection;
    const ui::LampSign sign = ui::sign_of(app, lamp);
    bool on = lamp_is_on(app, lamp);
    if (ImGui::Checkbox("##on", &on)) change |= switch_lamp(app, lamp, on);
    ui::tip(on ? "Shines. Click to switch it off." : "Switched off. Click to switch it on.");
    ImGui::SameLine();

    const Shine before = shine_of(app, lamp);
    Shine now = before;
    ImGui::BeginDisabled(!on);
    const bool recolored = ui::linear_color("##colour", now.color, "Colour of the light.");
    ImGui::EndDisabled();
    ImGui::SameLine();

    const float number = em(4.6f), gap = ImGui::GetStyle().ItemSpacing.x;
    const float width = ImGui::GetContentRegionAvail().x - number - gap;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    if (ImGui::InvisibleButton("name", {width, height})) s.lamp = s.lamp == lamp ? Lamp{} : lamp;
    if (ImGui::IsItemHovered()) s.hovered = lamp;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (s.lamp == lamp || ImGui::IsItemHovered())
        draw.AddRectFilled(at, {at.x + width, at.y + height},
                           theme::color(theme::rgb(s.lamp == lamp ? 0x484848 : 0x333333)),
                           ImGui::GetStyle().FrameRounding);
    const std::string name = lamp_name(app, lamp);
    ui::tip(fmt::format("{}\n{}\nClick for details.", name, ui::word_of(sign)).c_str());
    const bool edited = is_changed(app, lamp);
    const theme::Color color = !on ? theme::text_dim : edited ? theme::light : theme::text;
    ui::draw_sign(draw, {at.x + em(0.7f), at.y + height / 2}, em(0.42f), sign,
                  theme::color(on ? theme::light : theme::text_dim));
    draw.AddText({at.x + em(1.5f), at.y + ImGui::GetStyle().FramePadding.y}, theme::color(color),
                 ui::fitted(name, width - em(1.6f)).c_str());
    ImGui::SameLine();

    ImGui::BeginDisabled(!on);
    ImGui::SetNextItemWidth(number);
    double strength = now.strength;
    const bool moved = ui::drag_number("##strength", strength, 0, largest_light, "%.4g");
    ImGui::EndDisabled();
    ui::tip(strength_tip(sign));
    if (moved) now.strength = static_cast<float>(strength);
    if (recolored || moved) change |= set_shine(app, lamp, before, now);
    return change;
}

Change draw_list(App& app, const std::vector<Lamp>& list) {
    Change change;
    const float row = ImGui::GetFrameHeightWithSpacing();
    const bool scrolls = list.size() > rows_in_sight;
    // Half a row more shows that there are others.
    if (scrolls) ImGui::BeginChild("list", {0, row * (rows_in_sight + 0.5f)});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(list.size()), row);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            ImGui::PushID(i);
            change |= draw_row(app, list[static_cast<size_t>(i)]);
            ImGui::PopID();
        }
    if (scrolls) ImGui::EndChild();
    return change;
}

Change draw_light_details(App& app, int index) {
    const PunctualLight& file = app.document.prepared->file->lights[static_cast<size_t>(index)];
    LightEdit e = light_edit(app, index);
    constexpr std::array<ui::Choice, 3> kinds = {
        {{"Point", "From one point in all directions", theme::light},
         {"Spot", "From one point into a cone", theme::light},
         {"Sun",
          "Directional: parallel light from infinitely far. The strength is then an "
          "irradiance.",
          theme::light}}};
    bool changed = false;
    ui::begin_edit_row("Kind", "How the light leaves it.", e.kind.has_value());
    const bool other_kind = e.kind.has_value();
    int kind = static_cast<int>(e.kind.value_or(file.kind));
    if (ui::segmented("kind", kinds, kind)) {
        e.kind = static_cast<PunctualKind>(kind);
        changed = true;
    }
    if (ui::end_edit_row("Kind", std::string(to_string(file.kind)), other_kind)) {
        e.kind.reset();
        changed = true;
    }
    if (e.kind.value_or(file.kind) == PunctualKind::spot) {
        const auto angle = [&](const char* label, const char* tooltip, std::optional<float>& value,
                               float of_file, float low) {
            std::optional<float> degrees;
            if (value) degrees = glm::degrees(*value);
            if (!ui::edit_share(label, tooltip, degrees, glm::degrees(of_file), low, 90)) return;
            value.reset();
            if (degrees) value = std::clamp(glm::radians(*degrees), glm::radians(low), widest_cone);
            changed = true;
        };
        angle("Outer cone", "Angle from the axis at which the light ends, in degrees.",
              e.outer_angle, file.outer_cone_angle, 0.1f);
        angle("Inner cone",
              "Angle from the axis up to which it has its full strength, in degrees; never "
              "beyond the outer one.",
              e.inner_angle, file.inner_cone_angle, 0);
    }
    return changed ? change_light(app, index, std::move(e)) : Change{};
}

Change draw_material_details(App& app, int material) {
    const MaterialUse& use = material_use(app);
    const size_t k = static_cast<size_t>(material);
    ui::wrapped(theme::text_dim, fmt::format("Every surface of this material shines: {} triangle{} "
                                             "of {} object{}.",
                                             use.triangles[k], use.triangles[k] == 1 ? "" : "s",
                                             use.objects[k], use.objects[k] == 1 ? "" : "s"));
    if (ui::wide_button("Show its material", "Opens it below", -1)) select_material(app, material);
    return {};
}

std::string sky_in_words(const PreparedScene& p) {
    if (p.default_sky) return "soft default sky";
    if (!p.sky) return "none: black";
    if (!p.sky->map) return "one colour";
    return std::filesystem::path(p.sky->source).filename().string();
}

// Where the sky comes from; shown even where there is none yet.
Change draw_sky_source(App& app) {
    const PreparedScene& p = *app.document.prepared;
    FileFields& f = app.ui.panel.files;
    ui::row("Sky",
            "Light from infinitely far around the scene. Drop an .hdr or .exr on the window, "
            "or name one here.");
    const float button = app.document.options.sky ? em(3.6f) : 0;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(
        ui::fitted(sky_in_words(p), ImGui::GetContentRegionAvail().x - button).c_str());
    if (p.sky) ui::tip(p.sky->source.c_str());
    if (app.document.options.sky) {
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - em(3));
        if (ui::wide_button("File's", "Back to what the file says", -1))
            ask(app, ActionKind::set_sky);
    }
    if (p.default_sky)
        ui::note(
            theme::light,
            "The file has no light, so a soft default sky shines. Choose a sky to replace it.");
    ui::row("  Map", "An equirectangular map, .hdr or .exr. Enter uses it.");
    ImGui::SetNextItemWidth(-em(3.6f));
    const bool entered = ImGui::InputTextWithHint("##sky path", "path of .hdr or .exr", &f.sky_path,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if ((ui::wide_button("Use", "Uses this map as the sky", -1) || entered) && !f.sky_path.empty())
        ask(app, ActionKind::set_sky, f.sky_path);
    if (!p.sky || p.sky->map) {
        ui::row("", "");
        if (ui::wide_button("Use one colour",
                            "The same light from everywhere; its colour stands in the list.", -1))
            ask(app, ActionKind::set_sky, "0.5,0.5,0.5");
    }
    return {};
}

Change draw_rotation(App& app) {
    SceneOptions& o = app.document.options;
    const bool turned = o.sky_rotation_degrees != 0;
    ui::begin_edit_row("  Rotation",
                       "Of the sky about the vertical axis, in degrees, counter-clockwise seen "
                       "from above.",
                       turned);
    double degrees = o.sky_rotation_degrees;
    constexpr double low = -180, high = 180;
    const bool changed =
        ImGui::SliderScalar("##rotation", ImGuiDataType_Double, &degrees, &low, &high, "%.1f") &&
        std::isfinite(degrees);
    if (changed) o.sky_rotation_degrees = degrees;
    const bool back = ui::end_edit_row("  Rotation", "0", turned);
    if (back) o.sky_rotation_degrees = 0;
    return changed || back ? scene_changed : Change{};
}

Change draw_details(App& app, const Lamp& lamp) {
    Change change;
    ui::heading(lamp_name(app, lamp).c_str());
    ImGui::PushID("details");
    if (lamp.kind == LampKind::sky && app.document.prepared->sky->map) change |= draw_rotation(app);
    if (lamp.kind == LampKind::light) change |= draw_light_details(app, lamp.index);
    if (lamp.kind == LampKind::material) change |= draw_material_details(app, lamp.index);
    ImGui::BeginDisabled(!is_changed(app, lamp));
    if (ui::wide_button("Reset this light", "All of it as the file has it", -1))
        change |= reset_lamp(app, lamp);
    ImGui::EndDisabled();
    ImGui::PopID();
    return change;
}

Change draw_all_lamps(App& app) {
    SceneOptions& o = app.document.options;
    const bool marked = o.lamp_strength != 1;
    ui::begin_edit_row("All lamps", "Factor on every light but the sky.", marked);
    double factor = o.lamp_strength;
    const bool changed = ui::drag_number("##lamps", factor, 0, 1e6, "x %.4g");
    if (changed) o.lamp_strength = static_cast<float>(factor);
    const bool back = ui::end_edit_row("All lamps", "1", marked);
    if (back) o.lamp_strength = 1;
    return changed || back ? scene_changed : Change{};
}

}  // namespace

Change draw_lights(App& app) {
    app.ui.panel.selection.hovered = {};
    if (!ui::begin_section(app, ui::Side::right, "Lights", true)) return {};
    Change change;
    if (app.document.prepared) {
        material_use(app);
        const std::vector<Lamp> list = lamps(app);
        change |= draw_list(app, list);
        const Lamp selected = app.ui.panel.selection.lamp;
        if (std::find(list.begin(), list.end(), selected) != list.end())
            change |= draw_details(app, selected);
        change |= draw_all_lamps(app);
        change |= draw_sky_source(app);
    } else {
        ui::wrapped(theme::text_dim, "No scene is open.");
    }
    ui::end_section(app);
    return change;
}

}  // namespace midway
