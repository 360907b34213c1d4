// Rendering in waves: 1, 1, 2, 4, ... passes, each a whole number of passes, until a limit is met.
// How passes fall into waves never shows in the image; only where the render ends does.
#pragma once

#include <functional>
#include <optional>

#include "render/renderer.h"

namespace midway {

struct WaveLimits {
    std::optional<std::uint64_t> passes;
    std::optional<double> seconds;  // of rendering; the last wave may end a little later
};

struct WaveState {
    double done = 0;     // share of the limit that comes first
    double passes = 0;   // finished, with the share of the wave that is under way
    bool whole = false;  // between waves: the renderer is at rest
};

// Returns the seconds spent rendering. The first pass always finishes.
double render_in_waves(ProgressiveRenderer& renderer, const WaveLimits& limits,
                       const std::function<bool()>& stop,
                       const std::function<void(const WaveState&)>& progress);

}  // namespace midway
