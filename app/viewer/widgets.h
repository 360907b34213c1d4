// The few controls that ImGui lacks, and the form that all panels share: sections in two columns,
// rows of a label and a control, notes, tooltips. Sizes are multiples of the font's.
#pragma once

#include <imgui.h>

#include <span>
#include <string>

#include "viewer/state.h"
#include "viewer/theme.h"

namespace midway::ui {

inline float em(float n = 1) { return n * ImGui::GetFontSize(); }

// Windows of the two columns, set up by the layout panel; sections append to them.
enum class Side { left, right };

// True where the section is to be drawn; then end_section() must follow. False while all panels
// are hidden. Whether a section is open is kept in the arrangement.
bool begin_section(App& app, Side side, const char* title, bool open_at_first);
void end_section(App& app);

// For the item just drawn, where the mouse rests on it; also while it is disabled.
void tip(const char* text);

// Label at the left; the control that follows takes the rest of the width.
void row(const char* label, const char* tooltip);
// Room that is left for `count` equal controls side by side.
float share_of_width(int count);

// A small grey headline inside a section.
void heading(const char* text);

// Wrapped text in a colour, and the same with a bar of the colour at its left.
void wrapped(const theme::Color& color, const std::string& text);
void note(const theme::Color& color, const std::string& text);

struct Choice {
    const char* label;
    const char* tooltip;
    theme::Color accent{0.66f, 0.66f, 0.66f, 1};
    theme::Color accent_right{0, 0, 0, 0};  // right half of the underline; alpha 0: as accent
    bool enabled = true;
};

// Buttons side by side, one of which is chosen; true where another one was clicked.
bool segmented(const char* id, std::span<const Choice> choices, int& chosen);

// A checkbox that turns an optional value on and off, and its field; true where it changed.
bool optional_int(const char* label, const char* tooltip, std::optional<std::uint64_t>& value,
                  int when_on, const char* unit);
bool optional_number(const char* label, const char* tooltip, std::optional<double>& value,
                     double when_on, const char* format);

// A number in a field that is dragged or typed. Speed follows the size of the number.
bool drag_number(const char* id, double& value, double low, double high, const char* format);

// The MIS exponent, 0..8, with marks at naive 0, balance 1 and power 2: close to a mark it snaps.
bool exponent_slider(double& exponent);

// A button that fills the width given (0: by its text).
bool wide_button(const char* label, const char* tooltip, float width = 0);

// A sheet over the whole window, in its middle, with all else dimmed; a click beside it closes it.
void begin_sheet(const char* name, bool& open);
void end_sheet();

// "950", "1.2 k", "3.40 M".
std::string short_number(double n);

// Text that fits the width, its middle left out where it must.
std::string fitted(const std::string& text, float width);

}  // namespace midway::ui
