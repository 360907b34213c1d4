// The window in memory, for pictures and tests: EGL without a surface, or OSMesa where that is
// missing. Nothing is shown, nothing is remembered; time passes as ever.
#pragma once

#include "host.h"

namespace midway {

enum class OffscreenKind { automatic, egl, osmesa };

// Throws one line where neither can be had. `scale` stands for the monitor's.
Host make_offscreen(ivec2 size, float scale, OffscreenKind kind);

}  // namespace midway
