// The window on a desktop: GLFW with an OpenGL 3.3 core context.
#pragma once

#include "host.h"

namespace midway {

// Whether a desktop can be reached at all; where not, `reason` says why in a few words.
bool have_display(std::string& reason);

// Throws one line where there is no display or no OpenGL 3.3. ImGui's context must exist; its fonts
// may still change. The host must be let go before ImGui's context.
Host make_window(ivec2 size, const std::string& title);

}  // namespace midway
