// A short tour for the first visit; every step can be left.
#include <fmt/format.h>

#include <array>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

struct Step {
    const char* section;  // what is pointed at; empty: the image
    const char* title;
    const char* text;
};

constexpr std::array<Step, 8> steps = {{
    {"", "This is Midway",
     "A head of solid glass, lit by one small lamp. The image refines while you look at it. Drag "
     "to walk around the head, turn the wheel to come closer, double-click to set what you turn "
     "about. The bright pattern in front of the head is its caustic: light that went through the "
     "glass. Most renderers find it only by luck."},
    {"Technique", "Ways to find light",
     "Press 1: path tracing gets the caustic as noise. Press 2: light tracing draws it at once but "
     "leaves the glass black. Press 3: bidirectional path tracing joins walks from both ends. "
     "Press 4: auto leaves out what this scene does not need."},
    {"Technique", "What the weights do",
     "Each path can be found in many ways; the exponent decides how they are weighted. Go from "
     "power 2 to naive 0 and see the noise come. Tick \"Same paths\" and switching is instant: "
     "the weights alone change."},
    {"Technique", "The strategy pyramid",
     "Shift+P shows every way to find light as a picture of its own, a row for each number of "
     "bounces, from the camera's side to the light's. Click a cell to see it large, Shift+click "
     "adds another. \"Bare\" shows what it would give alone, \"Noise\" who makes the grain. The "
     "last cell of each row, light tracing, holds the caustic."},
    {"", "Inside a pixel",
     "Press I and click into the caustic: one sample is computed again, its walks are drawn in "
     "teal and amber, and bars show what each strategy would have given and with what weight. "
     "Shift+I finds the brightest sample of the image: who made that firefly?"},
    {"Compare", "A against B",
     "Shift+Y keeps the image as A. Change the technique, then press H: a line to drag parts A "
     "from B, H again shows their difference. \"Error over time\" draws a curve for every "
     "technique that you try."},
    {"Lights", "Change the scene",
     "Switch lamps off, give them another colour or strength. Press U and click an object to edit "
     "what it is made of. Ctrl+Z takes back. Exposure, tone curves and channels, under Display, "
     "never restart the render."},
    {"Files", "Bring your own scene",
     "Drop a .gltf or .glb file on the window, or an .hdr as its sky. The gallery holds seven more "
     "scenes. F1 shows all keys, Tab hides the panels."},
}};

// A frame around what the step speaks of; where that is, if it is in sight.
std::optional<Rect> point_at(const App& app, const Step& step) {
    const auto place = app.ui.panel.section_places.find(step.section);
    if (place == app.ui.panel.section_places.end() || !app.ui.panels) return {};
    const auto& [x0, y0, x1, y1] = place->second;
    const float room = em(0.4f);
    ImGui::GetForegroundDrawList()->AddRect({x0 - room, y0 - room / 2}, {x1 + room, y1},
                                            theme::color(theme::light), em(0.3f), 0, em(0.14f));
    return Rect{{x0, y0}, {x1, y1}};
}

void place_beside(const App& app, const std::optional<Rect>& target) {
    const vec2 middle = 0.5f * (app.ui.view.lower + app.ui.view.upper);
    if (!target) {
        ImGui::SetNextWindowPos({middle.x, app.ui.view.upper.y - em(3)}, ImGuiCond_Always,
                                {0.5f, 1});
        return;
    }
    const bool left = target->lower.x < middle.x;
    ImGui::SetNextWindowPos({left ? target->upper.x + em(1) : target->lower.x - em(1),
                             std::min(target->lower.y + em(1), app.ui.view.upper.y - em(16))},
                            ImGuiCond_Always, {left ? 0.0f : 1.0f, 0});
}

}  // namespace

Change draw_tour(App& app) {
    if (app.ui.first_visit && app.document.prepared) {
        app.ui.first_visit = false;
        app.ui.tour_step = 0;
    }
    int& step = app.ui.tour_step;
    if (step < 0 || app.ui.keys || app.ui.gallery) return {};
    const int count = static_cast<int>(steps.size());
    if (step >= count) {
        step = -1;
        return {};
    }
    const Step& now = steps[static_cast<size_t>(step)];
    place_beside(app, point_at(app, now));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {em(1), em(0.8f)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, em(0.4f));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, theme::rgb(0x171717, 0.96f));
    ImGui::Begin("##tour", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushFont(theme::heading_font());
    ImGui::TextUnformatted(now.title);
    ImGui::PopFont();
    ImGui::PushTextWrapPos(em(23));
    ImGui::TextUnformatted(now.text);
    ImGui::PopTextWrapPos();
    ImGui::Dummy({em(22), em(0.2f)});
    const bool last = step == count - 1;
    const int shown = step + 1;
    if (ImGui::Button(last ? "Done" : "Next")) ++step;
    if (shown > 1) {
        ImGui::SameLine();
        if (ImGui::Button("Back")) step = shown - 2;
    }
    if (!last) {
        ImGui::SameLine();
        if (ImGui::Button("Skip the tour")) step = -1;
    }
    ImGui::SameLine();
    ImGui::TextColored(theme::text_dim, "%d of %d", shown, count);
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
    return {};
}

}  // namespace midway
