// How light is found: technique, exponent of the MIS weights, what the technique does not cover.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "viewer/panels/parts.h"
#include "viewer/strategy_view.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

constexpr std::array<ui::Choice, 4> techniques = {{
    {"Path",
     "Path tracing: walks start at the camera; lights are hit by chance (emitter) or aimed at from "
     "every surface (next event). [1]",
     theme::camera},
    {"Light",
     "Light tracing: walks start at the lights; every surface they meet is joined to the lens. "
     "Shows "
     "nothing of what is seen in smooth mirrors or glass. [2]",
     theme::light},
    {"BDPT",
     "Bidirectional path tracing: walks from both ends, joined in every possible way, each way "
     "weighted by how well it finds that path (MIS). [3]",
     theme::camera, theme::light},
    {"Auto",
     "Bidirectional path tracing without what this scene does not need: a short pilot finds out "
     "which strategies and how many walks from the lights lower the error fastest. [4]",
     theme::camera, theme::light},
}};

const char* in_one_line(Technique t) {
    switch (t) {
        case Technique::path:
            return "Walks from the camera find the lights.";
        case Technique::light:
            return "Walks from the lights find the camera.";
        case Technique::bdpt:
            return "Walks from both ends, joined in every way.";
        case Technique::automatic:
            return "As much of BDPT as this scene needs.";
    }
    return "";
}

bool is_mark(double b) { return b == 0 || b == 1 || b == 2; }

bool is_accumulating(const App& app, double exponent) {
    if (!app.render.same_paths || !app.snapshot) return false;
    const std::vector<double>& have = app.snapshot->exponents;
    return std::find(have.begin(), have.end(), exponent) != have.end();
}

Change draw_exponent(App& app) {
    Change change;
    ui::heading("Exponent of the MIS weights");
    if (!is_mark(app.render.exponent)) {
        ImGui::SameLine();
        ImGui::Text("%.3g", app.render.exponent);
    }
    double exponent = app.render.exponent;
    if (ui::exponent_slider(exponent)) change |= choose_exponent(app, exponent);
    bool same = app.render.same_paths;
    if (ImGui::Checkbox("Same paths for all exponents", &same))
        change |= choose_same_paths(app, same);
    ui::tip(
        "The images of exponents 0, 1, 2 and one of your choice accumulate from the very same "
        "paths, "
        "so that switching between them is instant and what differs is the weights alone. [M]");
    if (same) {
        const std::string free = fmt::format("{:.3g}", app.render.free_exponent);
        const std::array<ui::Choice, 4> choices = {{{"0", "Naive: uniform weights [N]"},
                                                    {"1", "Balance heuristic [B]"},
                                                    {"2", "Power heuristic [P]"},
                                                    {free.c_str(), "The slider's own"}}};
        const std::array<double, 4> values{0, 1, 2, app.render.free_exponent};
        int chosen = static_cast<int>(std::find(values.begin(), values.end(), app.render.exponent) -
                                      values.begin());
        ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
        if (ui::segmented("shown", choices, chosen))
            change |= choose_exponent(app, values[static_cast<size_t>(chosen)]);
    }
    return change;
}

// What `auto` decided. The last decision stays, dim, until the next is made: nothing below it may
// jump at every turn of the camera.
void draw_plan(const App& app) {
    const bool known = app.snapshot && !app.snapshot->plan_in_words.empty();
    const bool decided = known && app.snapshot->scale == 1;
    ui::wrapped(decided ? theme::text : theme::text_dim,
                known ? app.snapshot->plan_in_words : "A pilot finds out what it needs ...");
    ui::tip(
        "Decided before the image begins, from 65,536 samples that never enter it. While the "
        "camera moves the last decision stays.");
}

void draw_not_covered(const App& app) {
    if (app.document.not_covered.empty()) return;
    std::string text = "Not covered by this technique:";
    for (const std::string& line : app.document.not_covered) text += "\n- " + line;
    ui::note(theme::light, text);
    ui::tip(
        "No strategy of this technique can make these paths, so their light is missing from the "
        "image, however long it renders.");
}

}  // namespace

Change choose_technique(App& app, Technique technique) {
    RenderSettings& s = app.render.settings;
    if (s.technique == technique) return {};
    s.technique = technique;
    s.families.reset();
    return {.settings = true};
}

Change choose_exponent(App& app, double exponent) {
    if (exponent == app.render.exponent) return {};
    app.render.exponent = exponent;
    const bool instant = is_accumulating(app, exponent);
    if (!is_mark(exponent)) app.render.free_exponent = exponent;
    return instant ? Change{.display = true} : Change{.settings = true};
}

Change choose_same_paths(App& app, bool on) {
    app.render.same_paths = on;
    return {.settings = true};
}

Change draw_technique(App& app) {
    if (!ui::begin_section(app, ui::Side::left, "Technique", true)) return {};
    Change change;
    int technique = static_cast<int>(app.render.settings.technique);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    if (ui::segmented("technique", techniques, technique))
        change |= choose_technique(app, static_cast<Technique>(technique));
    ui::wrapped(theme::text_dim, in_one_line(app.render.settings.technique));
    if (app.render.settings.technique == Technique::automatic) draw_plan(app);
    draw_not_covered(app);
    change |= draw_exponent(app);
    const bool open = app.display.pyramid.open;
    if (ui::wide_button(open ? "Close the strategy pyramid" : "Strategy pyramid",
                        "Every way to find light as a picture of its own, while the image goes on "
                        "refining: which strategy finds what, with what share of light, noise and "
                        "rays. [Shift+P]",
                        ImGui::GetContentRegionAvail().x)) {
        open_pyramid(app, !open);
        change.display = true;
    }
    ui::end_section(app);
    return change;
}

}  // namespace midway
