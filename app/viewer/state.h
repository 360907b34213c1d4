// The state of the window: plain structs that the shell and all panels share. Panels are free
// functions over App (panels/panels.h) that say what they changed; the loop (loop.h) gathers these
// once a frame and acts on them. Only the UI thread touches anything here. Positions on the screen
// are in ImGui's coordinates (points, y downwards); lengths of the scene in the file's units.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/tonemap.h"
#include "render/live_render.h"
#include "render/session.h"
#include "viewer/camera_control.h"
#include "viewer/compare_state.h"
#include "viewer/pyramid_choices.h"
#include "viewer/ui_state.h"
#include "viewer/undo.h"

namespace midway {

// What a panel, a key or a line of a script changed. Only camera, settings and scene restart the
// render, all of them through restart_render() in loop.cpp.
struct Change {
    bool display = false;   // how the image is shown: exposure, curve, channel, zoom
    bool camera = false;    // what Document::options say of the camera (camera_control.h)
    bool settings = false;  // App::render
    bool scene = false;     // the rest of Document::options

    Change& operator|=(const Change& o) {
        display |= o.display, camera |= o.camera, settings |= o.settings, scene |= o.scene;
        return *this;
    }
    bool restarts() const { return camera || settings || scene; }
    bool any() const { return display || restarts(); }
};

// The file that is open. A file that cannot be read leaves all but `error` as it was.
struct Document {
    std::string path;                               // .gltf, .glb or .midway; empty at first
    std::shared_ptr<const PreparedScene> prepared;  // null before; never changed once here
    SceneOptions options;                           // wishes beside the file: edits, camera
    std::vector<std::string> files;                 // what the scene was read from, and
    std::uint64_t stamp = 0;                        // file_stamp(files) then
    std::vector<std::string> warnings;
    std::vector<std::string> not_covered;  // by the technique in use, in words
    std::vector<std::string> left_out;     // because the scene does not need it, in words
    std::string loading;                   // path under way, empty where none is
    float progress = 0;                    // of loading, 0..1
    std::string stage;                     // of loading, in words
    std::string error;                     // one line; empty where all is well
};

// What a person chooses about light transport. `settings.exponents` is derived from the other
// members when a render starts. The image has settings.width x height pixels; with `fit_window`
// they follow the view when the window (not a panel) changes its size.
struct RenderChoices {
    RenderSettings settings{.technique = Technique::automatic};
    double exponent = 2;       // the one that is shown, 0..8
    double free_exponent = 4;  // the last one chosen that is none of 0, 1, 2
    bool same_paths = false;   // exponents 0, 1, 2 and free_exponent from the same paths
    bool fit_window = true;
    RenderLimits limits;
    int threads = 0;  // 0: all processors
    bool paused = false;
};

// Moving the camera. Where it is stands in Document::options, as for `midway render`; absent there,
// it is the file's (document.prepared->camera).
struct CameraChoices {
    dvec3 pivot{0};          // what orbiting turns about
    bool moving = false;     // a drag or a flight is under way
    bool animating = false;  // a glide or a flight: draw again without waiting for an event
    struct Bookmark {
        std::string name;
        View view;
    };
    std::vector<Bookmark> bookmarks;
};

enum class Channel { image, albedo, normal, depth, object, error, samples };

// How the image is shown; changes here never restart a render.
struct DisplayChoices {
    float exposure_ev = 0;
    bool auto_exposure = false;  // exposure_ev then follows the image
    Curve curve = Curve::srgb;
    bool false_colour = false;  // luminance in stops around `stop_low`..`stop_high`
    float stop_low = -8, stop_high = 8;
    Channel channel = Channel::image;
    float zoom = 0;            // screen pixels per image pixel; 0: as large as fits
    vec2 pan{0};               // where the image's centre is, from the view's centre, points
    bool pixel_values = true;  // written into the pixels where they are large enough
    PyramidChoices pyramid;
    bool operator==(const DisplayChoices&) const = default;
};

struct Rect {
    vec2 lower{0}, upper{0};
    vec2 size() const { return upper - lower; }
    bool contains(vec2 p) const {
        return p.x >= lower.x && p.y >= lower.y && p.x < upper.x && p.y < upper.y;
    }
};

// Panels and their arrangement. A panel with state of its own adds a struct of its own here.
struct Ui {
    bool panels = true;    // Tab
    bool keys = false;     // F1
    bool gallery = false;  // of assets/
    bool first_visit = false;
    int tour_step = -1;               // -1: not under way
    float scale = 1;                  // of fonts and spacing: the monitor's
    float pixels_per_point = 1;       // of the framebuffer
    Rect view;                        // where the image goes: what the panels leave free
    bool view_hovered = false;        // the mouse is over the image and not over a panel
    std::string notice;               // short line about what was just done ("saved out.exr")
    double notice_until = 0;          // in ImGui::GetTime()
    std::vector<std::string> recent;  // files, latest first
    PanelState panel;
};

// What the shell does at the end of the frame because a panel, a key, a drop or a script asked.
enum class ActionKind {
    open,               // text: path of .gltf, .glb, .midway
    set_sky,            // text: path of .hdr, .exr, or "R,G,B"; empty: the file's own
    reload,             // camera and edits stay
    save_image,         // text: path of .exr (as midway render writes it) or .png (as seen)
    save_session,       // text: path of .midway
    copy_command_line,  // to the clipboard
    quit,
    keep_image,      // text: its name, or empty
    load_reference,  // text: path of .exr, .hdr or .film; empty: none any more
    save_plot        // text: path of .png or .csv
};

struct Action {
    ActionKind kind;
    std::string text;
};

// Measurements of this window, in seconds; the newest last, of bounded length.
struct Timings {
    std::vector<float> frames;         // one UI frame, from its first line to its swap
    std::vector<float> edit_to_image;  // from an edit to its first image on the screen
    std::vector<float> stops;          // from the request to stop until all workers stood
    double first_pixels = 0;           // since the program started; 0: none yet
};

struct App {
    Document document;
    RenderChoices render;
    CameraChoices camera;
    DisplayChoices display;
    CompareState compare;
    Ui ui;
    std::shared_ptr<const Snapshot> snapshot;         // the newest; null before the first
    std::shared_ptr<const ChannelSnapshot> channels;  // albedo ... while one is shown
    UndoStack undo;                                   // of the document's wishes
    std::vector<Action> actions;                      // asked for in this frame
    Timings timings;
};

// Which image of the snapshot belongs to the slider's exponent; 0 where none does (yet).
inline size_t shown_exponent(const App& app) {
    if (app.snapshot)
        for (size_t i = 0; i < app.snapshot->exponents.size(); ++i)
            if (app.snapshot->exponents[i] == app.render.exponent) return i;
    return 0;
}

inline void ask(App& app, ActionKind kind, std::string text = {}) {
    app.actions.push_back({kind, std::move(text)});
}

// Shows a short line for some seconds. `now`: ImGui::GetTime().
inline void notify(App& app, std::string text, double now) {
    app.ui.notice = std::move(text);
    app.ui.notice_until = now + 4;
}

}  // namespace midway
