// The window's loop: wait for an event, let the panels and the script act on the state, act on what
// changed, draw. Nothing is drawn while nothing changed; nothing here waits for the renderer.
#pragma once

#include <optional>

#include "comparison.h"
#include "engine.h"
#include "gl_lines.h"
#include "gl_panels.h"
#include "host.h"
#include "pyramid_atlas.h"
#include "remember.h"
#include "report.h"
#include "script.h"

namespace midway {

struct LoopOptions {
    std::optional<int> frames;  // draw so many after the first image, then end
    std::string screenshot;     // of the last of them
    double seconds_before = 0;  // from the program's start to the loop
};

struct Loop {
    App& app;
    Engine& engine;
    const Host& host;
    ScriptPlayer script;
    Memory memory;
    LoopOptions options;

    Display display;
    LinePainter lines;
    PanelPainter painter;
    PyramidAtlas pyramid;
    ShownImage shown;

    // What `shown` was made from.
    std::shared_ptr<const Snapshot> shown_snapshot;
    std::shared_ptr<const ChannelSnapshot> shown_channels;
    DisplayChoices shown_choices;
    double shown_exponent = -1;
    CompareLook shown_look;

    Engine::Clock::time_point start = Engine::Clock::now();
    Engine::Clock::time_point last_frame = start;  // when it began
    ReportMark mark;
    ivec2 size{0};         // of the framebuffer
    int frames_due = 3;    // ImGui answers an event within three frames
    int frames_left = -1;  // of options.frames
    std::string title;
    bool quit = false;
};

Loop make_loop(App& app, Engine& engine, const Host& host);

// Until the window is closed. Throws what a script or OpenGL throws.
void run(Loop& loop);

}  // namespace midway
