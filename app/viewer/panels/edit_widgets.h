// What the panels of lights and materials share: signs for kinds of lights, colours in linear
// light, and rows that tell what was changed and take it back.
#pragma once

#include <imgui.h>

#include <string>

#include "viewer/edits.h"

namespace midway::ui {

enum class LampSign { point, spot, directional, area, sky };

LampSign sign_of(const App& app, const Lamp& lamp);
const char* word_of(LampSign sign);
void draw_sign(ImDrawList& draw, const ImVec2& middle, float radius, LampSign sign, ImU32 color);

// A field of colour that opens a picker. The picker works in sRGB, as pickers do; `linear` is what
// the file means. True where it was changed.
bool linear_color(const char* id, vec3& linear, const char* tooltip);

// A row whose value may differ from the file's: an amber label and a way back where it does.
// Between begin and end stands one control, as wide as it is let. True: back to the file's value.
void begin_edit_row(const char* label, const char* tooltip, bool changed);
bool end_edit_row(const char* label, const std::string& of_file, bool changed);

// A control for one value of an edit; true where it was changed or taken back.
bool edit_share(const char* label, const char* tooltip, std::optional<float>& value, float of_file,
                float low = 0, float high = 1);
bool edit_number(const char* label, const char* tooltip, std::optional<float>& value, float of_file,
                 float low, float high);
bool edit_color(const char* label, const char* tooltip, std::optional<vec3>& value,
                const vec3& of_file);

}  // namespace midway::ui
