// Where the window lives: on a desktop (window.h) or in memory (offscreen.h). The loop asks for
// no more than this. All but wake() belong to the UI thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "display.h"

namespace midway {

struct Host {
    std::shared_ptr<const Gl> gl;

    // Sets ImGui's input and size for the frame that begins.
    std::function<void()> begin_frame;
    std::function<Display::Target()> target;
    // Shows what was drawn.
    std::function<void()> end_frame;

    // Returns after an event, a wake(), or so many seconds (below zero: for ever).
    std::function<void(double seconds)> wait;
    std::function<void()> wake;  // from any thread
    // True once after each event of the desktop: something may look different.
    std::function<bool()> had_event;

    std::function<bool()> closing;
    std::function<void(ivec2)> resize;  // the window, in points
    std::function<void(const std::string&)> set_title;
    std::function<std::vector<std::string>()> dropped;  // files, since the last call
    float scale = 1;                                    // of the monitor
};

}  // namespace midway
