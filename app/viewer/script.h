// Scripts: what a person would do, one action a line, for tests and for the pictures of the README.
// Empty lines and what follows # are left out; words are parted by spaces, quotes keep them.
//
//   open FILE            set KEY VALUE (script_set.h)      camera orbit|look|dolly X [Y]
//   key NAME             Tab, F1, a, ctrl+s ...            type TEXT
//   move X Y             click X Y [right|double]          drag X0 Y0 X1 Y1 [right|middle]
//   scroll X Y STEPS     drop FILE                         resize WIDTHxHEIGHT
//   wait loaded | image | spp N | idle | saved | reload | seconds X
//        | frames N | inspected | measured | file F (until there is such a file)
//        | strategies N (passes in the pyramid; those chosen at full size)
//   inspect X,Y[,SAMPLE|,brightest] | brightest | nonfinite | path N | off
//   screenshot F.png     save F.exr|F.png                  save-session F.midway
//   edit light|material NAME|INDEX KEY VALUE           edit sky KEY VALUE (edits.h)
//   select X Y           undo        redo              reset (the scene as in the file)
//   copy F.txt           report F.json                     mark        reload
//   keep [NAME]          reference FILE|none               save-plot F.png|F.csv
//   timeout SECONDS      hands on|off                      quit
//
// Each action takes at least one frame of the window. `wait` fails after the timeout (120 s at
// first). `mark` starts the measurements of `report` anew. `orbit` turns by degrees, `look` too,
// `dolly` scales the distance to the pivot. `inspect` opens the path inspector on a pixel of the
// image; `path N` picks the N-th of its list, from 0 on; `wait inspected` until all is there.
// `keep` makes the shown image A, at its first whole pass; `wait measured` until the error of the
// newest image is known. After `hands off` mouse and keys are the desktop's. A line that cannot be
// carried out ends the window with exit status 1 and one line that names it.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "engine.h"
#include "host.h"

namespace midway {

struct ScriptLine {
    int number = 0;
    std::vector<std::string> words;
};

// Throws std::runtime_error with one line for a file that cannot be read or an action that does not
// exist.
std::vector<ScriptLine> read_script(const std::string& path);
std::vector<ScriptLine> parse_script(const std::string& text, const std::string& path);

// What the hands do during one frame.
struct InputStep {
    std::optional<vec2> mouse;
    int button = -1;  // held in this frame
    float scroll = 0;
    int key = 0;  // GLFW_KEY_*, pressed in this frame
    bool ctrl = false, shift = false;
    std::string text;
};

struct ScriptPlayer {
    using Clock = std::chrono::steady_clock;
    std::string path;
    std::vector<ScriptLine> lines;
    size_t next = 0;
    double timeout = 120;
    std::optional<Clock::time_point> waiting_since;
    int waiting_frames = 0;
    std::shared_ptr<const PreparedScene> scene_then;  // when the wait began
    std::deque<InputStep> input;
    vec2 mouse{0};
    bool hands = true;  // false: mouse and keys are left to the desktop
};

inline bool playing(const ScriptPlayer& p) { return p.next < p.lines.size() || !p.input.empty(); }

// Whether the script has something to do in a frame now; while it waits, no frame is drawn for it.
bool wants_frame(const ScriptPlayer& player, const App& app, const Engine& engine);

// Sets ImGui's input for the frame that begins; between the host's begin_frame() and NewFrame().
void give_input(ScriptPlayer& player);

struct ScriptStep {
    Change change;
    std::string screenshot, report;  // files to write at the end of this frame
    bool mark = false, quit = false;
};

// Carries out the next line, where it is time for it. Throws std::runtime_error with one line that
// names it.
ScriptStep play(ScriptPlayer& player, App& app, Engine& engine, const Host& host);

}  // namespace midway
