// One material with all that can be changed about it: that of the object clicked, or one from the
// list.
#include <fmt/format.h>

#include <filesystem>

#include "viewer/panels/edit_widgets.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

std::string title_of(const Material& m, size_t index) {
    return m.name.empty() ? fmt::format("Material {}", index) : m.name;
}

void draw_choice(App& app) {
    const std::vector<Material>& materials = app.document.prepared->file->materials;
    const int selected = selected_material(app);
    ui::row("Material", "Of the object that you click with Select, or one from this list.");
    ImGui::SetNextItemWidth(-ui::em(4.2f));
    const std::string shown =
        selected < 0 ? "none selected"
                     : title_of(materials[static_cast<size_t>(selected)], size_t(selected));
    if (ImGui::BeginCombo("##material", shown.c_str())) {
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(materials.size()));
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
                ImGui::PushID(i);
                const size_t k = static_cast<size_t>(i);
                if (ImGui::Selectable(title_of(materials[k], k).c_str(), i == selected))
                    select_material(app, i);
                ImGui::PopID();
            }
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    const bool picking = app.ui.panel.navigation.tool == ViewTool::select;
    if (ui::wide_button(picking ? "Click..." : "Select",
                        "Then click objects in the image to see and edit their material; dragging "
                        "still moves the camera. [U]",
                        -1))
        choose_tool(app, ViewTool::select);
}

void draw_place(App& app, int material) {
    const MaterialUse& use = material_use(app);
    const size_t k = static_cast<size_t>(material);
    const std::string& object = app.ui.panel.selection.object;
    const std::string used =
        fmt::format("{} object{}, {} triangle{}", use.objects[k], use.objects[k] == 1 ? "" : "s",
                    use.triangles[k], use.triangles[k] == 1 ? "" : "s");
    std::string text = object.empty() ? used : "\"" + object + "\"";
    if (!object.empty() && use.objects[k] > 1)
        text += fmt::format(" + {} more", use.objects[k] - 1);
    ui::row("Used by", "The objects that change with this material.");
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(ui::fitted(text, ImGui::GetContentRegionAvail().x).c_str());
    ui::tip(used.c_str());
}

// The texture that a value is multiplied with.
void draw_texture(const App& app, const TextureRef& texture, const char* what) {
    if (!texture.used()) return;
    const auto& image =
        app.document.prepared->description.images[static_cast<size_t>(texture.image)];
    const std::string name = image && !image->name.empty()
                                 ? std::filesystem::path(image->name).filename().string()
                                 : fmt::format("image {}", texture.image);
    const std::string text =
        image ? fmt::format("x {} ({}x{})", name, image->width, image->height) : "x " + name;
    ImGui::SetCursorPosX(ui::em(6.4f));
    ImGui::TextColored(theme::text_dim, "%s",
                       ui::fitted(text, ImGui::GetContentRegionAvail().x).c_str());
    ui::tip(what);
}

bool draw_surface(const App& app, const Material& m, MaterialEdit& e) {
    bool changed = ui::edit_color("Base colour", "Colour of the diffuse layer, or of the metal.",
                                  e.base_color, m.base_color);
    draw_texture(app, m.base_color_texture, "The texture is multiplied with the colour above.");
    changed |= ui::edit_share("Metallic", "0: plastic, wood, stone. 1: bare metal.", e.metallic,
                              m.metallic);
    changed |=
        ui::edit_share("Roughness", "0: a perfect mirror. 1: dull.", e.roughness, m.roughness);
    draw_texture(app, m.metallic_roughness_texture,
                 "The texture's blue is multiplied with Metallic, its green with Roughness.");
    changed |= ui::edit_share("Transmission",
                              "How much light enters through the surface: 1 is glass. Closed "
                              "meshes are solid bodies, open ones thin sheets.",
                              e.transmission, m.transmission);
    draw_texture(app, m.transmission_texture, "The texture's red is multiplied with it.");
    changed |= ui::edit_number("Index (IOR)",
                               "Index of refraction: water 1.33, glass 1.5, diamond 2.4. It sets "
                               "how strongly plastics reflect, too.",
                               e.ior, m.ior, 1, largest_ior);
    changed |= ui::edit_share("Specular", "Strength of the reflection of all but metals.",
                              e.specular, m.specular);
    draw_texture(app, m.specular_texture, "The texture's alpha is multiplied with it.");
    if (m.alpha_mode != AlphaMode::opaque)
        changed |= ui::edit_share("Opacity",
                                  "Alpha: how much of the surface is there. The file calls this "
                                  "material transparent.",
                                  e.alpha, m.alpha);
    return changed;
}

bool draw_emission(const App& app, const Material& m, MaterialEdit& e) {
    const EmissionParts parts = emission_parts(m);
    bool changed =
        ui::edit_number("Emission", "Radiance of the brightest of red, green and blue; 0: dark.",
                        e.emission_strength, parts.strength, 0, largest_light);
    if (e.emission_strength.value_or(parts.strength) > 0) {
        changed |= ui::edit_color("  Colour", "Of the light that it emits.", e.emission_color,
                                  parts.color);
        draw_texture(app, m.emission_texture, "The texture is multiplied with it.");
        if (!e.on) ui::note(theme::light, "Switched off in the list of lights.");
    }
    ui::begin_edit_row("Two-sided", "It shines from its back too.", e.double_sided.has_value());
    bool both = e.double_sided.value_or(m.double_sided);
    const bool marked = e.double_sided.has_value();
    if (ImGui::Checkbox("##value", &both)) {
        e.double_sided = both;
        changed = true;
    }
    if (ui::end_edit_row("Two-sided", m.double_sided ? "yes" : "no", marked)) {
        e.double_sided.reset();
        changed = true;
    }
    return changed;
}

}  // namespace

Change draw_material(App& app) {
    Selection& s = app.ui.panel.selection;
    if (s.show) app.ui.panel.arrangement.sections["Material"] = true;
    if (!ui::begin_section(app, ui::Side::right, "Material", false)) return {};
    Change change;
    if (!app.document.prepared) {
        ui::wrapped(theme::text_dim, "No scene is open.");
        ui::end_section(app);
        return change;
    }
    draw_choice(app);
    const int material = selected_material(app);
    if (material < 0) {
        ui::wrapped(theme::text_dim, "Press Select, then click an object in the image.");
    } else {
        draw_place(app, material);
        const Material& m = app.document.prepared->file->materials[static_cast<size_t>(material)];
        MaterialEdit e = material_edit(app, material);
        const bool edited = e != MaterialEdit{.name = e.name, .index = e.index};
        bool changed = draw_surface(app, m, e);
        changed |= draw_emission(app, m, e);
        ImGui::BeginDisabled(!edited);
        if (ui::wide_button("Reset this material", "All of its values as the file has them", -1)) {
            e = {};
            changed = true;
        }
        ImGui::EndDisabled();
        if (changed) {
            e.name = m.name;
            e.index = material;
            change |= change_material(app, material, std::move(e));
        }
        if (s.show) ImGui::SetScrollHereY(1);
    }
    s.show = false;
    ui::end_section(app);
    return change;
}

}  // namespace midway
