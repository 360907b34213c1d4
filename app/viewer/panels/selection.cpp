// Marks in the view: what is selected, and the lamp that the mouse rests on in the list.
#include <algorithm>
#include <cmath>

#include "viewer/panels/edit_widgets.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/view.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr size_t most_marks = 64;

Viewport viewport_of(const App& app) {
    return {static_cast<double>(app.render.settings.width),
            static_cast<double>(app.render.settings.height)};
}

std::optional<vec2> on_screen(const App& app, const View& view, const dvec3& point) {
    const auto at = project(view, viewport_of(app), point);
    if (!at) return {};
    return screen_position(app, vec2(*at));
}

// Rectangle of an object's bounds on the screen; empty where a corner lies behind the eye.
std::optional<Rect> object_rect(const App& app, const View& view, const MarkedObject& o) {
    Rect r{vec2(1e30f), vec2(-1e30f)};
    for (int k = 0; k < 8; ++k) {
        const dvec3 corner(k & 1 ? o.upper.x : o.lower.x, k & 2 ? o.upper.y : o.lower.y,
                           k & 4 ? o.upper.z : o.lower.z);
        const auto p = on_screen(app, view, corner);
        if (!p) return {};
        r.lower = glm::min(r.lower, *p);
        r.upper = glm::max(r.upper, *p);
    }
    r.lower = glm::max(r.lower, app.ui.view.lower + vec2(em(0.2f)));
    r.upper = glm::min(r.upper, app.ui.view.upper - vec2(em(0.2f)));
    if (!(r.lower.x < r.upper.x && r.lower.y < r.upper.y)) return {};
    return r;
}

// Four corners around a rectangle, light on dark.
void draw_corners(ImDrawList& draw, const Rect& r, const theme::Color& color, float alpha) {
    const vec2 size = r.size();
    const float arm = std::clamp(0.25f * std::min(size.x, size.y), em(0.3f), em(1.2f));
    for (const bool dark : {true, false}) {
        const float width = em(dark ? 0.26f : 0.13f);
        const ImU32 c = theme::color(dark ? theme::rgb(0) : color, alpha);
        for (int k = 0; k < 4; ++k) {
            const float x = k & 1 ? r.upper.x : r.lower.x, y = k & 2 ? r.upper.y : r.lower.y;
            const float dx = k & 1 ? -arm : arm, dy = k & 2 ? -arm : arm;
            draw.AddLine({x, y}, {x + dx, y}, c, width);
            draw.AddLine({x, y}, {x, y + dy}, c, width);
        }
    }
}

void draw_name(const App& app, ImDrawList& draw, vec2 at, const std::string& name) {
    const std::string text = ui::fitted(name, em(14));
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const Rect& v = app.ui.view;
    at = glm::clamp(at, v.lower + vec2(em(0.3f)),
                    v.upper - vec2(size.x + em(0.6f), size.y + em(0.3f)));
    draw.AddRectFilled({at.x - em(0.25f), at.y}, {at.x + size.x + em(0.25f), at.y + size.y},
                       theme::color(theme::rgb(0x171717, 0.85f)), em(0.2f));
    draw.AddText({at.x, at.y}, theme::color(theme::text), text.c_str());
}

template <class Belongs>
void find_marks(App& app, const Belongs& belongs) {
    Marks& marks = app.ui.panel.marks;
    const Geometry& g = *app.document.prepared->scene->geometry;
    marks.objects.clear();
    for (const Object& o : g.objects) {
        if (!belongs(o) || marks.objects.size() >= most_marks) continue;
        vec3 lower(1e30f), upper(-1e30f);
        for (const vec3& p : o.positions) {
            lower = glm::min(lower, p);
            upper = glm::max(upper, p);
        }
        const Normalisation& n = g.normalisation;
        marks.objects.push_back(
            {dvec3(lower) / n.scale + n.center, dvec3(upper) / n.scale + n.center});
    }
}

void mark_lamp(const App& app, ImDrawList& draw, const View& view, const Lamp& lamp) {
    bool named = false;
    for (const MarkedObject& o : app.ui.panel.marks.objects) {
        const auto r = object_rect(app, view, o);
        if (!r) continue;
        draw_corners(draw, *r, theme::light, 1);
        if (!named) draw_name(app, draw, {r->lower.x, r->upper.y + em(0.2f)}, lamp_name(app, lamp));
        named = true;
    }
}

void mark_light(const App& app, ImDrawList& draw, const View& view, const Lamp& lamp) {
    const PunctualLight& l = app.document.prepared->file->lights[static_cast<size_t>(lamp.index)];
    const auto at = on_screen(app, view, dvec3(l.to_world[3]));
    if (!at || !app.ui.view.contains(*at)) return;
    const ImVec2 p{at->x, at->y};
    draw.AddCircleFilled(p, em(0.95f), theme::color(theme::rgb(0x171717, 0.75f)));
    draw.AddCircle(p, em(0.95f), theme::color(theme::light), 0, em(0.1f));
    ui::draw_sign(draw, p, em(0.5f), ui::sign_of(app, lamp), theme::color(theme::light));
    draw_name(app, draw, {at->x + em(1.3f), at->y - em(0.5f)}, lamp_name(app, lamp));
}

// The object that was clicked: its outline where all of it is before the eye, and the point.
void mark_object(const App& app, ImDrawList& draw, const View& view) {
    const Selection& s = app.ui.panel.selection;
    const theme::Color white{1, 1, 1, 1};
    for (const MarkedObject& o : app.ui.panel.marks.objects)
        if (const auto r = object_rect(app, view, o)) draw_corners(draw, *r, white, 1);
    const auto at = on_screen(app, view, s.point);
    if (!at || !app.ui.view.contains(*at)) return;
    draw.AddCircle({at->x, at->y}, em(0.35f), theme::color(theme::rgb(0)), 0, em(0.22f));
    draw.AddCircle({at->x, at->y}, em(0.35f), theme::color(white), 0, em(0.1f));
    const std::string material = s.material_name.empty() ? "" : ": " + s.material_name;
    draw_name(app, draw, {at->x + em(0.8f), at->y - em(0.5f)}, s.object + material);
}

}  // namespace

Change draw_selection(App& app) {
    if (!app.document.prepared) return {};
    Selection& s = app.ui.panel.selection;
    Marks& marks = app.ui.panel.marks;
    const Lamp lamp = s.hovered;
    const bool object = s.seen_until > ImGui::GetTime() && s.instance >= 0;
    if (object) app.camera.animating = true;  // until the mark is gone
    if (lamp.kind == LampKind::none && !object) return {};
    const View view = current_view(app);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const void* geometry = app.document.prepared->scene->geometry.get();
    const int instance = lamp.kind == LampKind::none ? s.instance : -1;
    if (marks.of != geometry || marks.lamp != lamp || marks.instance != instance) {
        marks = {geometry, lamp, instance, {}};
        find_marks(app, [&](const Object& o) {
            return instance >= 0 ? o.instance == instance
                                 : lamp.kind == LampKind::material && o.material == lamp.index;
        });
    }
    if (instance >= 0)
        mark_object(app, draw, view);
    else if (lamp.kind == LampKind::light)
        mark_light(app, draw, view, lamp);
    else
        mark_lamp(app, draw, view, lamp);
    return {};
}

}  // namespace midway
