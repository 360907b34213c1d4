// What panels, keys and scripts do to single lights and materials, and how one is picked in the
// view. Indices are those of the file's lights and materials. All of it acts on
// Document::options.edits alone; nothing here waits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/state.h"

namespace midway {

inline constexpr Change scene_changed{.scene = true};

// The edit in force, or one without values; the values that it leads to, switched off or not.
LightEdit light_edit(const App& app, int light);
MaterialEdit material_edit(const App& app, int material);
Change change_light(App& app, int light, LightEdit edit);
Change change_material(App& app, int material, MaterialEdit edit);
Change change_sky(App& app, const SkyEdit& edit);

Change undo_edit(App& app);
Change redo_edit(App& app);
Change reset_scene(App& app);  // sky, lamps and materials as in the file
bool is_edited(const App& app);

// What stands in the list of lights: the sky, lamps without size, materials that shine in the file
// or by an edit.
std::vector<Lamp> lamps(const App& app);
std::string lamp_name(const App& app, const Lamp& lamp);
bool lamp_is_on(const App& app, const Lamp& lamp);
Change switch_lamp(App& app, const Lamp& lamp, bool on);

// Triangles and objects of each material, worked out once for each geometry.
const MaterialUse& material_use(App& app);

// The material that is being edited, -1 for none: what a file that was read again no longer holds
// is forgotten.
int selected_material(App& app);
void select_material(App& app, int material);

// Selects what is seen at a point of the screen; false where nothing is.
bool select_at(App& app, vec2 screen);

// "light|material NAME|INDEX KEY VALUE" and "sky KEY VALUE", keys as in a session (scene_edits.h);
// the value "file" takes an edit back. Throws std::invalid_argument.
Change edit_by_name(App& app, const std::vector<std::string>& words);

}  // namespace midway
