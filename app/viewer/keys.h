// The keyboard of the window: one table that the keys, the overlay of F1 and the tests share.
#pragma once

#include <span>

#include "viewer/state.h"

namespace midway {

enum KeyModifiers { no_modifiers = 0, with_ctrl = 1, with_shift = 2 };

struct KeyBinding {
    const char* group;
    int key;        // GLFW_KEY_*
    int modifiers;  // exactly these
    const char* shown;
    const char* what;  // empty: a second way to the line above, not listed
    Change (*act)(App& app);
};

std::span<const KeyBinding> key_bindings();

// What the mouse does, for the overlay.
struct MouseHint {
    const char* gesture;
    const char* what;
};
std::span<const MouseHint> mouse_hints();

// Runs what was pressed; nothing while a text field has the keyboard.
Change handle_keys(App& app);

}  // namespace midway
