// What stands over the image: loading, errors, the default sky, what was just done, the legend of
// false colours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "viewer/comparison.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr ImGuiWindowFlags floating = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

// Opens a window at a place of the view given in shares of it; `pivot` is the window's own.
void begin_floating(const App& app, const char* name, vec2 share, vec2 pivot, float shift = 0) {
    const Rect& v = app.ui.view;
    const vec2 at = v.lower + v.size() * share;
    const float margin = em(0.8f);
    const ImVec2 place{at.x + margin * (1 - 2 * pivot.x),
                       at.y + margin * (1 - 2 * pivot.y) + shift};
    ImGui::SetNextWindowPos(place, ImGuiCond_Always, {pivot.x, pivot.y});
    ImGui::SetNextWindowBgAlpha(0.9f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, em(0.3f));
    ImGui::Begin(name, nullptr, floating);
    ImGui::PopStyleVar();
}

// Text of at most the view's width; returns the height of its window.
float banner(const App& app, const char* name, const theme::Color& color, const std::string& text,
             float shift, bool* dismissed) {
    begin_floating(app, name, {0, 0}, {0, 0}, shift);
    const float room = app.ui.view.size().x - em(6);
    const ImVec2 one_line = ImGui::CalcTextSize(text.c_str());
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::min(room, one_line.x + 1));
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopTextWrapPos();
    if (dismissed) {
        ImGui::SameLine();
        *dismissed = ImGui::SmallButton("x");
        ui::tip("Understood");
    }
    const float height = ImGui::GetWindowHeight();
    ImGui::End();
    return height + em(0.4f);
}

void draw_banners(App& app) {
    float shift = 0;
    if (!app.document.error.empty()) {
        bool dismissed = false;
        shift += banner(app, "##error", theme::error, app.document.error, shift, &dismissed);
        if (dismissed) app.document.error.clear();
    }
    if (app.snapshot && !app.snapshot->error.empty())
        shift += banner(app, "##render error", theme::error, app.snapshot->error, shift, nullptr);
    if (app.document.prepared && app.document.prepared->default_sky)
        shift += banner(app, "##default sky", theme::light,
                        "This file has no light: a soft default sky shines (Lights > Sky).", shift,
                        nullptr);
    const char* hint = app.ui.panel.navigation.tool == ViewTool::focus
                           ? "Click the point that shall be sharp. Esc: never mind."
                       : app.ui.panel.navigation.tool == ViewTool::region
                           ? "Drag a rectangle over the image. Esc: never mind."
                       : app.ui.panel.navigation.tool == ViewTool::select
                           ? "Click an object to see and edit its material. Esc: done."
                           : nullptr;
    if (hint) banner(app, "##hint", theme::text, hint, shift, nullptr);
}

void draw_loading(const App& app) {
    const Document& d = app.document;
    if (d.loading.empty()) return;
    begin_floating(app, "##loading", {0.5f, 0.5f}, {0.5f, 0.5f});
    const std::string name = std::filesystem::path(d.loading).filename().string();
    ImGui::TextUnformatted(ui::fitted("Loading " + name, em(20)).c_str());
    ImGui::ProgressBar(d.progress, {em(20), em(0.5f)}, "");
    ImGui::TextColored(theme::text_dim, "%s", d.stage.c_str());
    ImGui::End();
}

void draw_notice(const App& app) {
    if (app.ui.notice.empty() || ImGui::GetTime() >= app.ui.notice_until) return;
    begin_floating(app, "##notice", {1, 1}, {1, 1});
    ImGui::TextUnformatted(ui::fitted(app.ui.notice, app.ui.view.size().x - em(4)).c_str());
    ImGui::End();
}

struct Legend {
    const char* title = "";
    float low = 0, high = 1;  // stops
    bool percent = false, counts = false;
};

std::optional<Legend> legend_of(const App& app) {
    const DisplayChoices& d = app.display;
    if (view_in_use(app) == CompareView::difference) return {};
    if (d.channel == Channel::image && d.false_colour)
        return Legend{"luminance after exposure, in stops", d.stop_low, d.stop_high};
    if (d.channel == Channel::error)
        return Legend{"estimated error of a pixel", error_stops.x, error_stops.y, true};
    if (d.channel == Channel::samples)
        return Legend{"samples of a pixel", sample_stops.x, sample_stops.y, false, true};
    return {};
}

std::string legend_label(const Legend& l, float stop) {
    const float percent = 100 * std::exp2(stop);
    if (l.percent) return fmt::format("{:.{}f} %", percent, percent < 1 ? 2 : 0);
    if (l.counts) return fmt::format("{:.0f}", std::exp2(stop));
    return fmt::format("{:+.3g}", stop);
}

void draw_legend(const App& app) {
    const std::optional<Legend> legend = legend_of(app);
    if (!legend) return;
    begin_floating(app, "##legend", {0, 1}, {0, 1});
    ImGui::TextColored(theme::text_dim, "%s", legend->title);
    const float width = std::min(em(20), app.ui.view.size().x - em(4)), height = em(0.8f);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const std::span<const vec3> ramp = stop_ramp();
    const float step = width / static_cast<float>(ramp.size() - 1);
    const auto color = [&](size_t i) {
        return IM_COL32(ramp[i].x * 255, ramp[i].y * 255, ramp[i].z * 255, 255);
    };
    for (size_t i = 0; i + 1 < ramp.size(); ++i) {
        const float x = at.x + static_cast<float>(i) * step;
        draw.AddRectFilledMultiColor({x, at.y}, {x + step, at.y + height}, color(i), color(i + 1),
                                     color(i + 1), color(i));
    }
    for (int i = 0; i <= 4; ++i) {
        const float share = static_cast<float>(i) / 4;
        const std::string text =
            legend_label(*legend, legend->low + share * (legend->high - legend->low));
        const float wide = ImGui::CalcTextSize(text.c_str()).x;
        const float x = std::clamp(at.x + share * width - wide / 2, at.x, at.x + width - wide);
        draw.AddText({x, at.y + height + em(0.1f)}, theme::color(theme::text), text.c_str());
    }
    ImGui::Dummy({width, height + ImGui::GetTextLineHeight()});
    ImGui::End();
}

// Which channel is shown, where it is not the image.
void draw_channel_name(const App& app) {
    const char* name = nullptr;
    switch (app.display.channel) {
        case Channel::albedo:
            name = "Albedo";
            break;
        case Channel::normal:
            name = "Normal: red +x, green +y, blue +z";
            break;
        case Channel::depth:
            name = "Depth: near is bright";
            break;
        case Channel::object:
            name = "Objects";
            break;
        default:
            return;
    }
    begin_floating(app, "##channel", {0, 1}, {0, 1});
    ImGui::TextUnformatted(name);
    ImGui::End();
}

}  // namespace

Change draw_overlays(App& app) {
    draw_banners(app);
    draw_loading(app);
    draw_legend(app);
    draw_channel_name(app);
    draw_notice(app);
    return {};
}

}  // namespace midway
