// What a comparison puts over the image: the line of the wipe with its handle, who is who, and the
// scale of the differences. And the key that flips to A.
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/comparison.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/view.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr ImGuiWindowFlags over =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBackground |
    ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr double tap_seconds = 0.3;  // longer is holding

// The part of the view that the image covers.
Rect visible_image(const App& app) {
    const Rect image = image_rect(app);
    return {glm::max(image.lower, app.ui.view.lower), glm::min(image.upper, app.ui.view.upper)};
}

// On a dark plate, so that it reads over any image. `pivot`: 0 begins at x, 1 ends there.
void caption(const std::string& text, float x, float y, float pivot) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const vec2 pad(em(0.5f), em(0.2f));
    const float left = x - pivot * (size.x + 2 * pad.x);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled({left, y}, {left + size.x + 2 * pad.x, y + size.y + 2 * pad.y},
                       theme::color(theme::rgb(0x141414), 0.82f), em(0.25f));
    draw.AddText({left + pad.x, y + pad.y}, theme::color(theme::text), text.c_str());
}

void draw_line(const Rect& r, float x, bool hot) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const float dark = std::max(1.0f, em(0.2f)), bright = std::max(1.0f, em(hot ? 0.12f : 0.07f));
    draw.AddLine({x, r.lower.y}, {x, r.upper.y}, theme::color(theme::rgb(0x000000), 0.5f), dark);
    draw.AddLine({x, r.lower.y}, {x, r.upper.y}, theme::color(theme::rgb(0xffffff), 0.9f), bright);
    const float y = (r.lower.y + r.upper.y) / 2, radius = em(0.85f), tip = em(0.26f);
    draw.AddCircleFilled({x, y}, radius, theme::color(theme::rgb(hot ? 0xffffff : 0xe4e4e4)), 24);
    const ImU32 ink = theme::color(theme::rgb(0x303030));
    for (const float way : {-1.0f, 1.0f})
        draw.AddTriangleFilled({x + way * 2.1f * tip, y}, {x + way * 0.7f * tip, y - 1.3f * tip},
                               {x + way * 0.7f * tip, y + 1.3f * tip}, ink);
}

Change draw_wipe(App& app) {
    Change change;
    const Rect r = visible_image(app), all = image_rect(app);
    if (r.size().x < em(2) || r.size().y < em(2)) return {};
    const float wanted = all.lower.x + app.compare.wipe * all.size().x;
    // Where the line is out of sight its handle waits at the edge.
    const float x = std::clamp(wanted, r.lower.x, r.upper.x), half = em(0.7f);
    ImGui::SetNextWindowPos({x - half, r.lower.y});
    ImGui::SetNextWindowSize({2 * half, r.size().y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("##wipe", nullptr, over);
    ImGui::PopStyleVar(2);
    ImGui::InvisibleButton("line", {2 * half, r.size().y});
    const bool active = ImGui::IsItemActive(), hot = active || ImGui::IsItemHovered();
    if (hot) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    // A quick hand lets go in the frame of its last move.
    if (active || ImGui::IsItemDeactivated()) {
        const float share = (ImGui::GetIO().MousePos.x - all.lower.x) / all.size().x;
        const float next = std::clamp(share, 0.0f, 1.0f);
        // A click that does not move leaves the line where it is.
        if (ImGui::GetIO().MouseDragMaxDistanceSqr[0] > 1 && next != app.compare.wipe) {
            app.compare.wipe = next;
            change.display = true;
        }
    }
    ImGui::End();
    draw_line(r, x, hot);
    const float top = r.lower.y + em(0.8f), gap = em(0.9f);
    caption(caption_a(app), x - gap, top, 1);
    caption(caption_b(app), x + gap, top, 0);
    return change;
}

// Symmetric scale with five marks.
void draw_scale(const App& app) {
    const CompareState& c = app.compare;
    const float range = c.relative ? c.relative_range : c.range;
    const Rect& v = app.ui.view;
    const float margin = em(0.8f), width = std::min(em(22), v.size().x - 4 * margin);
    const float pad = em(0.6f), bar = em(0.8f), line = ImGui::GetTextLineHeight();
    const vec2 size(width + 2 * pad, bar + 3 * line + 2.2f * pad);
    const vec2 at(v.lower.x + margin, v.upper.y - margin - size.y);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled({at.x, at.y}, {at.x + size.x, at.y + size.y},
                       theme::color(theme::panel, 0.9f), em(0.3f));
    const char* title = c.relative ? "(B - A) / A: share of A's luminance"
                                   : "B - A: luminance after exposure, white is 1";
    draw.AddText({at.x + pad, at.y + pad / 2}, theme::color(theme::text_dim), title);
    const float y = at.y + pad + line, x = at.x + pad;
    const std::span<const vec3> ramp = signed_ramp();
    const float step = width / static_cast<float>(ramp.size() - 1);
    const auto color = [&](size_t i) {
        return IM_COL32(ramp[i].x * 255, ramp[i].y * 255, ramp[i].z * 255, 255);
    };
    for (size_t i = 0; i + 1 < ramp.size(); ++i) {
        const float left = x + static_cast<float>(i) * step;
        draw.AddRectFilledMultiColor({left, y}, {left + step, y + bar}, color(i), color(i + 1),
                                     color(i + 1), color(i));
    }
    for (int i = 0; i <= 4; ++i) {
        const float share = static_cast<float>(i) / 4, value = (2 * share - 1) * range;
        std::string text =
            c.relative ? fmt::format("{:+.3g} %", 100 * value) : fmt::format("{:+.3g}", value);
        if (i == 2) text = "0";
        const float wide = ImGui::CalcTextSize(text.c_str()).x;
        const float left = std::clamp(x + share * width - wide / 2, x, x + width - wide);
        draw.AddText({left, y + bar + em(0.1f)}, theme::color(theme::text), text.c_str());
    }
    const char* brighter = "B is brighter";
    const float below = y + bar + em(0.1f) + line;
    draw.AddText({x, below}, theme::color(theme::text_dim), "B is darker");
    draw.AddText({x + width - ImGui::CalcTextSize(brighter).x, below},
                 theme::color(theme::text_dim), brighter);
}

// Let go after a while: as it was before. After a tap it stays.
Change follow_flip_key(App& app) {
    CompareState& c = app.compare;
    if (c.flip_pressed < 0 || ImGui::IsKeyDown(GLFW_KEY_Y)) return {};
    const bool held = ImGui::GetTime() - c.flip_pressed > tap_seconds;
    c.flip_pressed = -1;
    return held ? flip_to_a(app) : Change{};
}

}  // namespace

Change flip_to_a(App& app) {
    CompareState& c = app.compare;
    if (c.view == CompareView::kept) return choose_compare(app, c.before_flip);
    c.before_flip = c.view;
    return choose_compare(app, CompareView::kept);
}

Change draw_compare_view(App& app) {
    Change change = follow_flip_key(app);
    const Rect& v = app.ui.view;
    const float middle = (v.lower.x + v.upper.x) / 2, top = visible_image(app).lower.y + em(0.8f);
    switch (view_in_use(app)) {
        case CompareView::live:
            if (app.compare.view > CompareView::kept && !view_refusal(app).empty())
                caption("A is of another view: " + view_refusal(app), middle, top, 0.5f);
            break;
        case CompareView::kept: {
            const std::string why = view_refusal(app);
            caption(caption_a(app) + (why.empty() ? "" : " (another view: " + why + ")"), middle,
                    top, 0.5f);
            break;
        }
        case CompareView::wipe:
            change |= draw_wipe(app);
            break;
        case CompareView::difference:
            caption(caption_b(app) + "  less  " + caption_a(app), middle, top, 0.5f);
            draw_scale(app);
            break;
    }
    return change;
}

}  // namespace midway
