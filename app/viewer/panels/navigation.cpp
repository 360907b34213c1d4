// The hand on the camera: gestures of the mouse in the view, flight, the wheel, and the tools that
// a click serves (focus, region). Left drag orbits, middle or Shift+left pans, right drag dollies;
// WASDQE with the right button held flies. With Ctrl the image itself is zoomed and panned.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

#include "viewer/edits.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/view.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

Viewport viewport_of(const App& app) {
    return {static_cast<double>(app.render.settings.width),
            static_cast<double>(app.render.settings.height)};
}

vec2 mouse_on_screen() {
    const ImVec2 m = ImGui::GetIO().MousePos;
    return {m.x, m.y};
}

dvec2 mouse_in_image(const App& app) { return dvec2(image_position(app, mouse_on_screen())); }

const Scene& scene_of(const App& app) { return *app.document.prepared->scene; }

// What is under a pixel; where that is the sky, a point as far as the pivot.
dvec3 point_under(const App& app, const View& view, const dvec2& pixel) {
    const Viewport port = viewport_of(app);
    if (const auto hit = surface_at(scene_of(app), view, port, pixel)) return *hit;
    const double depth = depth_of(view, app.camera.pivot);
    return view.eye +
           pixel_direction(view, port, pixel) * (depth > 0 ? depth : scene_radius(scene_of(app)));
}

FlyInput fly_input(const App& app) {
    const auto axis = [](int plus, int minus) {
        return static_cast<double>(ImGui::IsKeyDown(plus)) - ImGui::IsKeyDown(minus);
    };
    FlyInput in;
    in.forward = axis(GLFW_KEY_W, GLFW_KEY_S);
    in.right = axis(GLFW_KEY_D, GLFW_KEY_A);
    in.up = axis(GLFW_KEY_E, GLFW_KEY_Q);
    in.speed = 0.5 * scene_radius(scene_of(app)) * app.ui.panel.navigation.speed;
    if (ImGui::GetIO().KeyShift) in.speed *= 4;
    return in;
}

Gesture gesture_of_press(const App& app) {
    const ImGuiIO& io = ImGui::GetIO();
    const Navigation& n = app.ui.panel.navigation;
    if (io.KeyCtrl && (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(2)))
        return Gesture::image_pan;
    if (ImGui::IsMouseClicked(2)) return Gesture::pan;
    if (ImGui::IsMouseClicked(1)) return Gesture::dolly;
    if (!ImGui::IsMouseClicked(0) || n.tool == ViewTool::focus) return Gesture::none;
    if (n.tool == ViewTool::region) return Gesture::region;
    return io.KeyShift ? Gesture::pan : Gesture::orbit;
}

bool is_held(Gesture g) {
    switch (g) {
        case Gesture::none:
            return false;
        case Gesture::dolly:
        case Gesture::fly:
            return ImGui::IsMouseDown(1);
        case Gesture::pan:
        case Gesture::image_pan:
            return ImGui::IsMouseDown(0) || ImGui::IsMouseDown(2);
        case Gesture::orbit:
        case Gesture::region:
            return ImGui::IsMouseDown(0);
    }
    return false;
}

Change focus_at_mouse(App& app) {
    const View view = current_view(app);
    choose_tool(app, ViewTool::orbit);
    const auto hit = surface_at(scene_of(app), view, viewport_of(app), mouse_in_image(app));
    if (!hit) {
        notify(app, "nothing there to focus on", ImGui::GetTime());
        return {};
    }
    SceneOptions& o = app.document.options;
    o.focus_distance = depth_of(view, *hit);
    const double aperture =
        o.aperture_radius.value_or(app.document.prepared->camera.aperture_radius);
    // A pinhole has no focus: the lens is opened a little, so that the click shows.
    if (!(aperture > 0)) o.aperture_radius = 0.01 * *o.focus_distance;
    return {.camera = true};
}

void begin(App& app) {
    Navigation& n = app.ui.panel.navigation;
    const Gesture gesture = gesture_of_press(app);
    if (gesture == Gesture::none) return;
    n.gesture = gesture;
    n.mouse = n.region_start = mouse_in_image(app);
    n.dragged = false;
    n.to.reset();
    n.wheel.log_factor = 0;
    if (gesture == Gesture::pan || gesture == Gesture::dolly)
        n.held = point_under(app, current_view(app), n.mouse);
    if (gesture == Gesture::orbit && n.tool == ViewTool::orbit)
        n.pivot_seen_until = ImGui::GetTime() + 0.6;
}

bool orbits_by_drag_alone(ViewTool tool) {
    return tool == ViewTool::inspect || tool == ViewTool::select;
}

// With such a tool in hand a click is no orbit, though the hand may shake.
bool is_click(const App& app) {
    const Navigation& n = app.ui.panel.navigation;
    const double points = zoom_in_use(app) * glm::length(mouse_in_image(app) - n.region_start);
    return orbits_by_drag_alone(n.tool) && n.gesture == Gesture::orbit && !n.dragged &&
           points < ui::em(0.3f);
}

Change end(App& app) {
    Navigation& n = app.ui.panel.navigation;
    Change change;
    if (is_click(app)) {
        const auto pixel = pixel_at(app, mouse_on_screen());
        if (n.tool == ViewTool::inspect && pixel) inspect_pixel(app, *pixel);
        if (n.tool == ViewTool::select && !select_at(app, mouse_on_screen()))
            notify(app, "nothing there to select", ImGui::GetTime());
    }
    if (n.gesture == Gesture::fly)
        app.camera.pivot = natural_pivot(scene_of(app), current_view(app));
    if (n.gesture == Gesture::region) {
        const Viewport port = viewport_of(app);
        const dvec2 limit(port.width, port.height);
        const dvec2 a = glm::clamp(glm::min(n.region_start, n.mouse), dvec2(0), limit);
        const dvec2 b = glm::clamp(glm::max(n.region_start, n.mouse), dvec2(0), limit);
        const PixelRect r{static_cast<int>(a.x), static_cast<int>(a.y),
                          static_cast<int>(std::ceil(b.x)), static_cast<int>(std::ceil(b.y))};
        if (r.width() >= 4 && r.height() >= 4) {
            app.render.settings.crop = r;
            change.settings = true;
        }
        choose_tool(app, ViewTool::orbit);
    }
    n.gesture = Gesture::none;
    return change;
}

Change drag(App& app) {
    Navigation& n = app.ui.panel.navigation;
    if (is_click(app)) return {};
    n.dragged = true;
    if (n.gesture == Gesture::dolly && !ImGui::GetIO().WantTextInput) {
        const FlyInput in = fly_input(app);
        if (in.forward != 0 || in.right != 0 || in.up != 0) n.gesture = Gesture::fly;
    }
    const dvec2 mouse = mouse_in_image(app), moved = mouse - n.mouse;
    if (moved == dvec2(0)) return {};
    n.mouse = mouse;
    const View view = current_view(app);
    const Viewport port = viewport_of(app);
    switch (n.gesture) {
        case Gesture::orbit:
            n.pivot_seen_until = ImGui::GetTime() + 0.6;
            return move_to(app, orbit(view, app.camera.pivot, moved, port));
        case Gesture::pan:
            return move_to(app, pan(view, port, n.held, mouse));
        case Gesture::dolly:
            return move_to(app, dolly(view, n.held, std::exp(3 * moved.y / port.height),
                                      scene_radius(scene_of(app))));
        case Gesture::fly:
            return move_to(app, look_around(view, moved, port));
        case Gesture::image_pan: {
            const ImVec2 d = ImGui::GetIO().MouseDelta;
            if (app.display.zoom == 0) app.display.zoom = zoom_in_use(app);
            app.display.pan += vec2(d.x, d.y);
            n.mouse = mouse_in_image(app);
            return {.display = true};
        }
        case Gesture::region:
        case Gesture::none:
            break;
    }
    return {.display = true};
}

Change turn_wheel(App& app) {
    const ImGuiIO& io = ImGui::GetIO();
    Navigation& n = app.ui.panel.navigation;
    const float turns = io.MouseWheel;
    if (turns == 0) return {};
    if (n.gesture == Gesture::fly) {
        n.speed = std::clamp(n.speed * std::pow(1.25, turns), 1e-3, 1e3);
        return {};
    }
    if (!app.ui.view_hovered || n.gesture != Gesture::none) return {};
    if (io.KeyCtrl) {
        zoom_about(app, {io.MousePos.x, io.MousePos.y}, std::pow(1.25f, turns));
        return {.display = true};
    }
    n.to.reset();
    n.wheel.towards = point_under(app, current_view(app), mouse_in_image(app));
    n.wheel.log_factor = std::clamp(n.wheel.log_factor - 0.18 * turns, -3.0, 3.0);
    return {};
}

// What goes on by itself: glides, the wheel's rest, flight.
Change animate(App& app) {
    Navigation& n = app.ui.panel.navigation;
    const double seconds = std::min<double>(ImGui::GetIO().DeltaTime, 0.1);
    app.camera.animating = false;
    Change change;
    if (n.to) {
        n.to->elapsed += seconds;
        change |= move_to(app, glide_view(*n.to));
        if (finished(*n.to)) n.to.reset();
    }
    if (n.wheel.log_factor != 0)
        change |=
            move_to(app, advance(n.wheel, current_view(app), scene_radius(scene_of(app)), seconds));
    const FlyInput in = n.gesture == Gesture::fly ? fly_input(app) : FlyInput{};
    if (n.gesture == Gesture::fly || n.velocity != dvec3(0)) {
        if (is_moving(n.velocity, in)) {
            change |= move_to(app, fly(current_view(app), n.velocity, in, seconds));
        } else {
            n.velocity = dvec3(0);
        }
    }
    app.camera.animating = n.to || n.wheel.log_factor != 0 || n.velocity != dvec3(0);
    return change;
}

void draw_marks(const App& app) {
    const Navigation& n = app.ui.panel.navigation;
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const double now = ImGui::GetTime();
    if (n.pivot_seen_until > now) {
        const auto at = project(current_view(app), viewport_of(app), app.camera.pivot);
        if (at) {
            const vec2 p = screen_position(app, vec2(*at));
            const float fade = static_cast<float>(std::min(1.0, (n.pivot_seen_until - now) / 0.4));
            const float r = ui::em(0.5f);
            draw.AddCircle({p.x, p.y}, r, theme::color(theme::rgb(0), fade), 0, ui::em(0.22f));
            draw.AddCircle({p.x, p.y}, r, theme::color(theme::camera, fade), 0, ui::em(0.1f));
            draw.AddCircleFilled({p.x, p.y}, ui::em(0.12f), theme::color(theme::camera, fade));
        }
    }
    if (n.gesture == Gesture::region) {
        const vec2 a = screen_position(app, vec2(n.region_start));
        const vec2 b = screen_position(app, vec2(n.mouse));
        draw.AddRect({a.x, a.y}, {b.x, b.y}, theme::color(theme::rgb(0)), 0, 0, ui::em(0.2f));
        draw.AddRect({a.x, a.y}, {b.x, b.y}, theme::color(theme::rgb(0xffffff)), 0, 0,
                     ui::em(0.08f));
    }
    if (app.ui.view_hovered && n.tool != ViewTool::orbit)
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
}

}  // namespace

View current_view(const App& app) {
    const PreparedScene& p = *app.document.prepared;
    return view_in(app.document.options, p.camera, app.camera.pivot);
}

Change move_to(App& app, const View& view) {
    use_view(view, app.document.prepared->camera, app.document.options);
    return {.camera = true};
}

void choose_tool(App& app, ViewTool tool) {
    Navigation& n = app.ui.panel.navigation;
    n.tool = n.tool == tool ? ViewTool::orbit : tool;
}

Change frame_whole_scene(App& app) {
    if (!app.document.prepared) return {};
    const auto bounds = scene_bounds(app.document.prepared->description);
    if (!bounds) return {};
    const View view = current_view(app);
    const Viewport port = viewport_of(app);
    const View to = frame(view, *bounds, port.width / port.height);
    app.camera.pivot = to.target;
    app.ui.panel.navigation.to = ViewGlide{view, to, 0};
    app.camera.animating = true;
    return {};
}

Change draw_navigation(App& app) {
    if (!app.document.prepared) return {};
    Navigation& n = app.ui.panel.navigation;
    const void* geometry = scene_of(app).geometry.get();
    if (n.pivot_of != geometry) {
        n = Navigation{.tool = orbits_by_drag_alone(n.tool) ? n.tool : ViewTool::orbit,
                       .speed = n.speed};
        n.pivot_of = geometry;
        app.camera.pivot = natural_pivot(scene_of(app), current_view(app));
    }
    Change change;
    if (n.gesture != Gesture::none) {
        change |= drag(app);
        if (!is_held(n.gesture)) change |= end(app);
    } else if (app.ui.view_hovered) {
        if (n.tool == ViewTool::focus && ImGui::IsMouseClicked(0)) {
            change |= focus_at_mouse(app);
        } else if (n.tool == ViewTool::orbit && ImGui::IsMouseDoubleClicked(0)) {
            app.camera.pivot = point_under(app, current_view(app), mouse_in_image(app));
            n.pivot_seen_until = ImGui::GetTime() + 1.5;
        } else {
            begin(app);
        }
    }
    change |= turn_wheel(app);
    change |= animate(app);
    const bool of_camera = n.gesture != Gesture::none && n.gesture != Gesture::region &&
                           n.gesture != Gesture::image_pan;
    app.camera.moving = of_camera || app.camera.animating;
    // The mark of the pivot fades: draw until it is gone.
    app.camera.animating |= n.pivot_seen_until > ImGui::GetTime();
    draw_marks(app);
    return change;
}

}  // namespace midway
