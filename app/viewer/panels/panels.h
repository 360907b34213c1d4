// Panels: free functions that draw one part of the window with ImGui from App, change App, and say
// what they changed. A new panel is one file here, and one line in the table of panels.cpp.
//
// For all of them:
// - keys are GLFW_KEY_* codes in ImGui::IsKeyPressed(), with or without a real window;
// - nothing waits for the renderer and nothing reads files: ask(app, ActionKind::...) instead;
// - the first entry of the table arranges the others and sets app.ui.view, the part of the window
//   that is left to the image; view.h turns screen positions into pixels of the image.
#pragma once

#include <span>

#include "viewer/state.h"

namespace midway {

using PanelFunction = Change (*)(App&);

struct Panel {
    const char* name;
    PanelFunction draw;
};

// In the order in which they are called, once a frame, between ImGui::NewFrame() and Render().
std::span<const Panel> panels();

// Colours, spacing and fonts; called at the start and when the monitor's scale changes, outside of
// a frame. Replaces the fonts of the atlas; the caller uploads it.
void apply_theme(float scale);

}  // namespace midway
