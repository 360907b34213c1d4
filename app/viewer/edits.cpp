#include "viewer/edits.h"

#include <imgui.h>

#include <algorithm>

#include "viewer/view.h"

namespace midway {
namespace {

const FileContents& file_of(const App& app) { return *app.document.prepared->file; }

template <class T>
const T& item(const std::vector<T>& list, int index) {
    return list[static_cast<size_t>(index)];
}

bool usable(const std::vector<Material>& materials, int index, const std::string& name) {
    return index >= 0 && static_cast<size_t>(index) < materials.size() &&
           item(materials, index).name == name;
}

Change take(App& app, std::optional<SceneOptions> wishes) {
    if (!wishes) return {};
    app.document.options = std::move(*wishes);
    return scene_changed;
}

// Which materials a list of edits gives a light of their own.
std::vector<bool> shining(const App& app) {
    const std::vector<Material>& materials = file_of(app).materials;
    std::vector<bool> shines(materials.size());
    for (size_t i = 0; i < materials.size(); ++i)
        shines[i] = max_component(materials[i].emission) > 0;
    const auto& edits = app.document.options.edits.materials;
    const std::vector<int> at = places(edits, materials);
    for (size_t k = 0; k < edits.size(); ++k)
        if (at[k] >= 0)
            shines[static_cast<size_t>(at[k])] =
                shines[static_cast<size_t>(at[k])] ||
                max_component(values_of(item(materials, at[k]), edits[k]).emission) > 0;
    return shines;
}

}  // namespace

LightEdit light_edit(const App& app, int light) {
    return edit_of(app.document.options.edits, file_of(app).lights, light);
}

MaterialEdit material_edit(const App& app, int material) {
    return edit_of(app.document.options.edits, file_of(app).materials, material);
}

Change change_light(App& app, int light, LightEdit edit) {
    set_edit(app.document.options.edits, file_of(app).lights, light, std::move(edit));
    return scene_changed;
}

Change change_material(App& app, int material, MaterialEdit edit) {
    set_edit(app.document.options.edits, file_of(app).materials, material, std::move(edit));
    return scene_changed;
}

Change change_sky(App& app, const SkyEdit& edit) {
    app.document.options.edits.sky = edit;
    const auto& sky = app.document.prepared->sky;
    auto& color = app.document.options.edits.sky.color;
    if (sky && color == sky->color) color.reset();
    return scene_changed;
}

Change undo_edit(App& app) { return take(app, step_back(app.undo, app.document.options)); }
Change redo_edit(App& app) { return take(app, step_forth(app.undo, app.document.options)); }

Change reset_scene(App& app) {
    if (!is_edited(app)) return {};
    SceneOptions of_file;
    app.document.options = with_scene_of(of_file, app.document.options);
    return scene_changed;
}

bool is_edited(const App& app) { return !same_scene(app.document.options, SceneOptions{}); }

std::vector<Lamp> lamps(const App& app) {
    std::vector<Lamp> list;
    if (!app.document.prepared) return list;
    if (app.document.prepared->sky) list.push_back({LampKind::sky, 0});
    for (size_t i = 0; i < file_of(app).lights.size(); ++i)
        list.push_back({LampKind::light, static_cast<int>(i)});
    const std::vector<bool> shines = shining(app);
    const std::vector<size_t>& triangles = app.ui.panel.use.triangles;
    for (size_t i = 0; i < shines.size(); ++i)
        if (shines[i] && (i >= triangles.size() || triangles[i] > 0))
            list.push_back({LampKind::material, static_cast<int>(i)});
    return list;
}

std::string lamp_name(const App& app, const Lamp& lamp) {
    if (lamp.kind == LampKind::sky) return "Sky";
    const std::string& name = lamp.kind == LampKind::light
                                  ? item(file_of(app).lights, lamp.index).name
                                  : item(file_of(app).materials, lamp.index).name;
    return name.empty() ? "unnamed " + std::to_string(lamp.index) : name;
}

bool lamp_is_on(const App& app, const Lamp& lamp) {
    if (lamp.kind == LampKind::sky) return app.document.options.edits.sky.on;
    return lamp.kind == LampKind::light ? light_edit(app, lamp.index).on
                                        : material_edit(app, lamp.index).on;
}

Change switch_lamp(App& app, const Lamp& lamp, bool on) {
    if (lamp.kind == LampKind::sky) {
        SkyEdit e = app.document.options.edits.sky;
        e.on = on;
        return change_sky(app, e);
    }
    if (lamp.kind == LampKind::light) {
        LightEdit e = light_edit(app, lamp.index);
        e.on = on;
        return change_light(app, lamp.index, std::move(e));
    }
    MaterialEdit e = material_edit(app, lamp.index);
    e.on = on;
    return change_material(app, lamp.index, std::move(e));
}

const MaterialUse& material_use(App& app) {
    MaterialUse& use = app.ui.panel.use;
    const Geometry& g = *app.document.prepared->scene->geometry;
    if (use.of == &g) return use;
    use.of = &g;
    use.triangles.assign(file_of(app).materials.size(), 0);
    use.objects = use.triangles;
    for (const Object& o : g.objects) {
        use.triangles[static_cast<size_t>(o.material)] += o.triangles.size();
        ++use.objects[static_cast<size_t>(o.material)];
    }
    return use;
}

int selected_material(App& app) {
    Selection& s = app.ui.panel.selection;
    if (!app.document.prepared || !usable(file_of(app).materials, s.material, s.material_name))
        s.material = -1;
    return s.material;
}

void select_material(App& app, int material) {
    Selection& s = app.ui.panel.selection;
    s.material = material;
    s.material_name = item(file_of(app).materials, material).name;
    s.instance = -1;
    s.object.clear();
    s.show = true;
}

bool select_at(App& app, vec2 screen) {
    if (!app.document.prepared || !pixel_at(app, screen)) return false;
    const PreparedScene& p = *app.document.prepared;
    const View view = view_in(app.document.options, p.camera, app.camera.pivot);
    const RenderSettings& settings = app.render.settings;
    const auto picked = object_at(*p.scene, view, {double(settings.width), double(settings.height)},
                                  dvec2(image_position(app, screen)));
    if (!picked) return false;
    const Object& o = p.scene->geometry->objects[static_cast<size_t>(picked->object)];
    select_material(app, o.material);
    Selection& s = app.ui.panel.selection;
    s.instance = o.instance;
    s.object = o.name;
    s.point = picked->point;
    s.seen_until = ImGui::GetTime() + 2;
    return true;
}

}  // namespace midway
