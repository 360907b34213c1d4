// What the window remembers from one visit to the next: in $XDG_CONFIG_HOME/midway or
// ~/.config/midway, the file imgui.ini, with ImGui's own words and a section of ours (recent files,
// the window's size, the tour's end). Offscreen windows and scripts neither read nor write it.
#pragma once

#include <string>

#include "state.h"

namespace midway {

struct Memory {
    std::string path;  // of imgui.ini; empty: remember nothing
    ivec2 window{1280, 800};
    bool read = false;  // there was such a file: not the first visit
};

// Finds the file and reads it into ImGui and `app`. ImGui's context must exist. Throws nothing: a
// folder that cannot be made means that nothing is remembered.
Memory recall(App& app);

// Writes it, where it is remembered.
void keep(const App& app, Memory& memory);

}  // namespace midway
