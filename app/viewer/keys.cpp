#include "viewer/keys.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "viewer/edits.h"
#include "viewer/panels/parts.h"
#include "viewer/strategy_view.h"
#include "viewer/view.h"

namespace midway {
namespace {

constexpr Change shown{.display = true};

Change expose(App& app, float stops) {
    app.display.exposure_ev = std::clamp(app.display.exposure_ev + stops, -30.0f, 30.0f);
    app.display.auto_exposure = false;
    return shown;
}

Change next_channel(App& app, int step) {
    constexpr int count = static_cast<int>(Channel::samples) + 1;
    const int now = static_cast<int>(app.display.channel);
    app.display.channel = static_cast<Channel>((now + step + count) % count);
    return shown;
}

Change next_curve(App& app) {
    const int now = static_cast<int>(app.display.curve);
    app.display.curve = static_cast<Curve>((now + 1) % 3);
    return shown;
}

Change toggle_zoom(App& app) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (app.display.zoom > 0) {
        app.display.zoom = 0;
        app.display.pan = vec2(0);
    } else {
        zoom_about(app, {mouse.x, mouse.y}, 1 / app.ui.pixels_per_point / zoom_in_use(app));
    }
    return shown;
}

Change zoom_by(App& app, float factor) {
    zoom_about(app, 0.5f * (app.ui.view.lower + app.ui.view.upper), factor);
    return shown;
}

Change save(App& app, ActionKind kind, const char* extension) {
    if (app.document.prepared) ask(app, kind, free_name(app.ui.panel.files.save_name, extension));
    return {};
}

// Puts away what lies on top.
Change put_away(App& app) {
    if (app.ui.keys) {
        app.ui.keys = false;
    } else if (app.ui.gallery) {
        app.ui.gallery = false;
    } else if (app.ui.tour_step >= 0) {
        app.ui.tour_step = -1;
    } else if (app.ui.panel.navigation.tool != ViewTool::orbit) {
        app.ui.panel.navigation.tool = ViewTool::orbit;
    } else if (!app.display.pyramid.selected.empty()) {
        show_whole_image(app);
        return shown;
    } else if (app.display.pyramid.open) {
        open_pyramid(app, false);
        return shown;
    }
    return {};
}

// A tap changes over, holding shows A for as long (panels/compare_view.cpp).
Change press_flip(App& app) {
    if (app.compare.flip_pressed < 0) app.compare.flip_pressed = ImGui::GetTime();
    return flip_to_a(app);
}

Change next_compare_view(App& app) {
    switch (app.compare.view) {
        case CompareView::wipe:
            return choose_compare(app, CompareView::difference);
        case CompareView::difference:
            return choose_compare(app, CompareView::live);
        default:
            return choose_compare(app, CompareView::wipe);
    }
}

Change type_path(App& app) {
    app.ui.panels = app.ui.panel.arrangement.right = true;
    app.ui.panel.arrangement.sections["Files"] = true;
    app.ui.panel.files.focus_open = true;
    return {};
}

Change pause(App& app) {
    app.render.paused = !app.render.paused;
    return {};
}

Change tool(App& app, ViewTool t) {
    choose_tool(app, t);
    return {};
}

Change inspect_brightest(App& app) {
    if (!app.document.prepared) return {};
    InspectorState& s = app.ui.panel.inspector;
    app.ui.panel.navigation.tool = ViewTool::inspect;
    wish_for(s, Find::brightest_pixel, s.wish.pixel, 0);
    return {};
}

template <typename T>
Change toggle(T& value) {
    value = !value;
    return {};
}

template <typename T>
Change toggle_shown(T& value) {
    value = !value;
    return shown;
}

Change request(App& app, ActionKind kind) {
    if (kind == ActionKind::quit || app.document.prepared) ask(app, kind);
    return {};
}

constexpr const char* how = "How light is found";
constexpr const char* seen = "How it is shown";
constexpr const char* against = "A against B";
constexpr const char* where = "Camera";
constexpr const char* run = "Run and files";
constexpr const char* window = "Window";

using A = App&;
const auto bindings = std::to_array<KeyBinding>({
    {how, GLFW_KEY_1, 0, "1", "path tracing",
     [](A a) { return choose_technique(a, Technique::path); }},
    {how, GLFW_KEY_2, 0, "2", "light tracing",
     [](A a) { return choose_technique(a, Technique::light); }},
    {how, GLFW_KEY_3, 0, "3", "bidirectional",
     [](A a) { return choose_technique(a, Technique::bdpt); }},
    {how, GLFW_KEY_4, 0, "4", "auto: what the scene needs",
     [](A a) { return choose_technique(a, Technique::automatic); }},
    {how, GLFW_KEY_N, 0, "N", "exponent 0: naive", [](A a) { return choose_exponent(a, 0); }},
    {how, GLFW_KEY_B, 0, "B", "exponent 1: balance", [](A a) { return choose_exponent(a, 1); }},
    {how, GLFW_KEY_P, 0, "P", "exponent 2: power", [](A a) { return choose_exponent(a, 2); }},
    {how, GLFW_KEY_M, 0, "M", "same paths for all",
     [](A a) { return choose_same_paths(a, !a.render.same_paths); }},
    {how, GLFW_KEY_I, 0, "I", "inspect: then click a pixel",
     [](A a) { return tool(a, ViewTool::inspect); }},
    {how, GLFW_KEY_I, with_shift, "Shift+I", "inspect the brightest sample", inspect_brightest},
    {seen, GLFW_KEY_RIGHT_BRACKET, 0, "] and [", "half a stop brighter, darker",
     [](A a) { return expose(a, 0.5f); }},
    {seen, GLFW_KEY_LEFT_BRACKET, 0, "", "", [](A a) { return expose(a, -0.5f); }},
    {seen, GLFW_KEY_RIGHT_BRACKET, with_shift, "Shift+] and [", "in small steps",
     [](A a) { return expose(a, 0.1f); }},
    {seen, GLFW_KEY_LEFT_BRACKET, with_shift, "", "", [](A a) { return expose(a, -0.1f); }},
    {seen, GLFW_KEY_X, 0, "X", "automatic exposure",
     [](A a) { return toggle_shown(a.display.auto_exposure); }},
    {seen, GLFW_KEY_T, 0, "T", "next tone curve", next_curve},
    {seen, GLFW_KEY_C, 0, "C", "false colour",
     [](A a) { return toggle_shown(a.display.false_colour); }},
    {seen, GLFW_KEY_V, 0, "V, Shift+V", "channel: next, previous",
     [](A a) { return next_channel(a, 1); }},
    {seen, GLFW_KEY_V, with_shift, "", "", [](A a) { return next_channel(a, -1); }},
    {seen, GLFW_KEY_P, with_shift, "Shift+P", "strategy pyramid",
     [](A a) { return open_pyramid(a, !a.display.pyramid.open), shown; }},
    {seen, GLFW_KEY_Z, 0, "Z", "zoom: one to one, or fit", toggle_zoom},
    {seen, GLFW_KEY_EQUAL, 0, "+ and -", "zoom in and out", [](A a) { return zoom_by(a, 1.25f); }},
    {seen, GLFW_KEY_EQUAL, with_shift, "", "", [](A a) { return zoom_by(a, 1.25f); }},
    {seen, GLFW_KEY_KP_ADD, 0, "", "", [](A a) { return zoom_by(a, 1.25f); }},
    {seen, GLFW_KEY_MINUS, 0, "", "", [](A a) { return zoom_by(a, 0.8f); }},
    {seen, GLFW_KEY_KP_SUBTRACT, 0, "", "", [](A a) { return zoom_by(a, 0.8f); }},
    {against, GLFW_KEY_Y, with_shift, "Shift+Y", "keep this image as A", keep_as_a},
    {against, GLFW_KEY_Y, 0, "Y", "flip to A; held: while it is down", press_flip},
    {against, GLFW_KEY_H, 0, "H", "next: wipe, difference, B alone", next_compare_view},
    {against, GLFW_KEY_H, with_shift, "Shift+H", "plot of the error over time",
     [](A a) { return toggle_shown(a.compare.large_plot); }},
    {where, GLFW_KEY_F, 0, "F or Home", "frame the whole scene", frame_whole_scene},
    {where, GLFW_KEY_HOME, 0, "", "", frame_whole_scene},
    {where, GLFW_KEY_L, 0, "L", "focus: then click a point",
     [](A a) { return tool(a, ViewTool::focus); }},
    {where, GLFW_KEY_K, 0, "K", "store this view", store_bookmark},
    {where, GLFW_KEY_J, 0, "J", "go to the next stored view",
     [](A a) { return recall_bookmark(a, a.ui.panel.navigation.bookmark + 1); }},
    {where, GLFW_KEY_U, 0, "U", "select: then click an object",
     [](A a) { return tool(a, ViewTool::select); }},
    {run, GLFW_KEY_Z, with_ctrl, "Ctrl+Z", "undo a change of the scene", undo_edit},
    {run, GLFW_KEY_Z, with_ctrl | with_shift, "Ctrl+Shift+Z", "and do it again", redo_edit},
    {run, GLFW_KEY_Y, with_ctrl, "", "", redo_edit},
    {run, GLFW_KEY_SPACE, 0, "Space", "pause, go on", pause},
    {run, GLFW_KEY_R, 0, "R", "begin again", restart},
    {run, GLFW_KEY_R, with_shift, "Shift+R", "region: then drag it",
     [](A a) { return tool(a, ViewTool::region); }},
    {run, GLFW_KEY_O, with_ctrl, "Ctrl+O", "open a file by its path", type_path},
    {run, GLFW_KEY_G, 0, "G", "gallery of scenes", [](A a) { return toggle(a.ui.gallery); }},
    {run, GLFW_KEY_F5, 0, "F5", "read the file again",
     [](A a) { return request(a, ActionKind::reload); }},
    {run, GLFW_KEY_S, with_ctrl, "Ctrl+S", "save the image as EXR",
     [](A a) { return save(a, ActionKind::save_image, ".exr"); }},
    {run, GLFW_KEY_P, with_ctrl, "Ctrl+P", "save it as PNG, as seen",
     [](A a) { return save(a, ActionKind::save_image, ".png"); }},
    {run, GLFW_KEY_S, with_ctrl | with_shift, "Ctrl+Shift+S", "save a session",
     [](A a) { return save(a, ActionKind::save_session, ".midway"); }},
    {run, GLFW_KEY_C, with_ctrl, "Ctrl+C", "copy as command line",
     [](A a) { return request(a, ActionKind::copy_command_line); }},
    {window, GLFW_KEY_TAB, 0, "Tab", "hide or show all panels",
     [](A a) { return toggle(a.ui.panels); }},
    {window, GLFW_KEY_F1, 0, "F1", "these keys", [](A a) { return toggle(a.ui.keys); }},
    {window, GLFW_KEY_ESCAPE, 0, "Esc", "put away what lies on top", put_away},
    {window, GLFW_KEY_Q, with_ctrl, "Ctrl+Q", "quit",
     [](A a) { return request(a, ActionKind::quit); }},
});

constexpr std::array<MouseHint, 8> hints = {{
    {"Left drag", "orbit about the pivot"},
    {"Double click", "set the pivot there"},
    {"Middle or Shift+left drag", "pan"},
    {"Wheel", "go where the mouse is"},
    {"Right drag", "go nearer and farther"},
    {"Right + W A S D Q E", "fly; the wheel sets the speed"},
    {"Ctrl+wheel, Ctrl+drag", "zoom and move pixels"},
    {"Ctrl+click on a number", "type it"},
}};

}  // namespace

std::span<const KeyBinding> key_bindings() { return bindings; }
std::span<const MouseHint> mouse_hints() { return hints; }

Change handle_keys(App& app) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput) return {};
    const int held = (io.KeyCtrl ? with_ctrl : 0) | (io.KeyShift ? with_shift : 0);
    Change change;
    for (const KeyBinding& b : bindings)
        if (b.modifiers == held && !io.KeyAlt && !io.KeySuper && ImGui::IsKeyPressed(b.key, false))
            change |= b.act(app);
    return change;
}

}  // namespace midway
