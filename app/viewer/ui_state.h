// What the panels themselves remember: tools in hand, gestures under way, fields being typed. Plain
// data; nothing here has a say in an image.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/settings.h"
#include "viewer/camera_control.h"
#include "viewer/gallery.h"
#include "viewer/inspector_state.h"

namespace midway {

struct Snapshot;          // render/live_render.h
struct StrategySnapshot;  // render/live_strategies.h

// How the window is arranged; worth keeping from one visit to the next.
struct Arrangement {
    bool left = true, right = true;        // the two columns
    bool right_fits = true;                // else its sections stand in the left one
    std::map<std::string, bool> sections;  // open or closed, by title; absent: as by default
};

// What a click or a drag of the left button in the view does; with `inspect` and `select` a drag
// still orbits.
enum class ViewTool { orbit, focus, region, inspect, select };

enum class Gesture { none, orbit, pan, dolly, fly, region, image_pan };

// The hand on the camera (panels/navigation.cpp).
struct Navigation {
    ViewTool tool = ViewTool::orbit;
    Gesture gesture = Gesture::none;
    dvec2 mouse{0};               // at the last frame, in image pixels
    dvec3 held{0};                // the point that a pan keeps under the mouse
    dvec2 region_start{0};        // where the gesture began, image pixels
    bool dragged = false;         // the mouse has moved since
    DollyGlide wheel;             // what the wheel still has to do
    std::optional<ViewGlide> to;  // on the way to a view
    dvec3 velocity{0};
    double speed = 1;  // of flight: a factor on half the scene's radius per second
    int bookmark = -1;
    const void* pivot_of = nullptr;  // the geometry that the pivot was chosen in
    double pivot_seen_until = 0;     // the mark of the pivot fades, in ImGui::GetTime()
};

// One line of the log.
struct Message {
    enum class Kind { notice, error } kind = Kind::notice;
    std::string text;
    double time = 0;  // ImGui::GetTime()
};

// Fields of the file panel.
struct FileFields {
    std::string open_path, sky_path, save_name;
    bool focus_open = false;    // Ctrl+O: the field takes the keyboard
    std::string save_name_for;  // the document that save_name was made for
};

// What the status line works out once for each snapshot.
struct StatusCache {
    const Snapshot* of = nullptr;
    std::uint64_t job = 0, passes = 0;
    double exponent = 0;
    std::optional<double> error;
};

// Kinds of what stands in the list of lights; indices are those of the file.
enum class LampKind { none, sky, material, light };
struct Lamp {
    LampKind kind = LampKind::none;
    int index = 0;
    bool operator==(const Lamp&) const = default;
};

// What is being edited. Names tell whether a file that was read again still means the same.
struct Selection {
    int material = -1;
    std::string material_name;
    int instance = -1;      // the object that was clicked
    std::string object;     // its name
    dvec3 point{0};         // where it was clicked
    Lamp lamp;              // in the list of lights
    Lamp hovered;           // there, in this frame
    double seen_until = 0;  // the mark in the view, in ImGui::GetTime()
    bool show = false;      // the panel comes into sight
};

// What is worked out once for each scene: triangles and objects of each material.
struct MaterialUse {
    const void* of = nullptr;
    std::vector<size_t> triangles, objects;
};

// Bounds of marked objects in the file's units, and what they were found for.
struct MarkedObject {
    dvec3 lower{0}, upper{0};
};
struct Marks {
    const void* of = nullptr;  // geometry
    Lamp lamp;
    int instance = -1;
    std::vector<MarkedObject> objects;
};

// The strategy pyramid beside the image.
struct PyramidPanel {
    float share = 0.57f;           // of the width that the columns leave
    std::array<float, 4> place{};  // left, top, right and bottom
    // The thumbnails in one texture of OpenGL (0: none yet), and what they were made from.
    std::uint32_t picture = 0;
    std::shared_ptr<const StrategySnapshot> drawn;
    // Why a strategy takes no part, by strategy_index; empty where it does. Found once for a job.
    std::vector<std::string> left_out;
    std::uint64_t left_out_job = 0;
    std::optional<Plan> left_out_plan;
    const void* left_out_scene = nullptr;
    // Cells as drawn last, for the report.
    struct Cell {
        int s = 0, t = 0;
        float x = 0, y = 0;  // its middle
        bool left_out = false;
    };
    std::vector<Cell> cells;
};

struct PanelState {
    Arrangement arrangement;
    Navigation navigation;
    FileFields files;
    Selection selection;
    MaterialUse use;
    Marks marks;
    StatusCache status;
    PyramidPanel pyramid;
    std::vector<Message> messages;                           // the newest last
    std::string last_notice, last_error, last_render_error;  // already in `messages`
    double last_notice_until = 0;
    std::optional<std::vector<GalleryEntry>> gallery;  // absent before it was opened
    // Left, top, right and bottom of the sections as drawn last, by title.
    std::map<std::string, std::array<float, 4>> section_places;
    std::string open_section;  // being drawn
    InspectorState inspector;
    std::array<float, 4> dock{};  // left, top, right and bottom of what lies below the view
};

}  // namespace midway
