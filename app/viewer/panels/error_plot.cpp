// How the error falls with time, one curve for each technique tried: against a reference, or as the
// two halves of the samples tell it.
#include <fmt/format.h>
#include <imgui.h>
// After imgui.h.
#include <imgui_stdlib.h>

#include <array>
#include <cmath>

#include "viewer/comparing.h"
#include "viewer/comparison.h"
#include "viewer/panels/parts.h"
#include "viewer/plot_drawing.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

Change draw_reference_state(App& app) {
    Change change;
    CompareState& c = app.compare;
    if (!c.reference) return change;
    const LoadedReference& r = *c.reference;
    const ivec2 size(r.reference->image.width, r.reference->image.height);
    if (r.refusal.empty()) {
        const std::string name = r.path.substr(r.path.find_last_of('/') + 1);
        ui::wrapped(theme::text_dim, fmt::format("Measured against {}", name));
    } else if (!r.fits) {
        ui::note(theme::light, fmt::format("The reference has {} x {} pixels: it fits no image of "
                                           "another size.",
                                           size.x, size.y));
        if (ui::wide_button(fmt::format("Render {} x {}", size.x, size.y).c_str(),
                            "Begins the image anew at the reference's size.", -1)) {
            app.render.fit_window = false;
            app.render.settings.width = size.x;
            app.render.settings.height = size.y;
            app.render.settings.crop.reset();
            change.settings = true;
        }
    } else {
        ui::note(theme::light, "The reference is of another image: " + r.refusal + ".");
        if (ui::wide_button("It shows this image, too",
                            "Takes the reference to be of what is shown now.", -1))
            use_reference_here(app);
    }
    return change;
}

Change draw_reference(App& app) {
    CompareState& c = app.compare;
    const float buttons = em(c.reference ? 5.4f : 4.2f);
    ImGui::SetNextItemWidth(-buttons);
    const bool entered =
        ImGui::InputTextWithHint("##reference", "reference: path of .exr, .film", &c.reference_path,
                                 ImGuiInputTextFlags_EnterReturnsTrue);
    ui::tip(
        "An image of the same view and size that is known to be right, as midway render writes "
        "it. Without one, errors are estimated.");
    ImGui::SameLine();
    if (c.reference) {
        if (ui::wide_button("Put away", "Errors are estimated again.", -1))
            ask(app, ActionKind::load_reference);
        if (entered && !c.reference_path.empty())
            ask(app, ActionKind::load_reference, c.reference_path);
    } else if ((ui::wide_button("Load", "Measures errors against this image.", -1) || entered) &&
               !c.reference_path.empty()) {
        ask(app, ActionKind::load_reference, c.reference_path);
    }
    return draw_reference_state(app);
}

void draw_metric(CompareState& c) {
    if (!c.reference) {
        ui::wrapped(theme::text_dim, "Estimated relMSE, from two halves of the samples");
        return;
    }
    constexpr std::array<ui::Choice, 4> metrics = {{
        {"relMSE", "Mean of (x - r)^2 / (r^2 + 0.01 m^2); m: the reference's mean luminance."},
        {"trimmed", "The same without the 0.1 % of the pixels that are worst."},
        {"bias", "Relative difference of the image means, without its sign."},
        {"estimate", "What relMSE is without a reference, from two halves of the samples."},
    }};
    int metric = static_cast<int>(c.metric);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    if (ui::segmented("metric", metrics, metric)) c.metric = static_cast<ErrorMetric>(metric);
}

// The plot in what room there is, with what the mouse is over.
void draw_in(const Plot& plot, const ImVec2& size, bool legend) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("plot", size);
    const PlotLayout layout =
        lay_out(plot, {{at.x, at.y}, {at.x + size.x, at.y + size.y}}, ImGui::GetFontSize());
    std::optional<PlotHit> hit;
    if (ImGui::IsItemHovered()) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        hit = plot_hit(plot, layout, {mouse.x, mouse.y}, em(2));
        if (hit)
            ImGui::SetTooltip("%s", describe(plot, *hit).c_str());
        else
            ui::tip(
                "Both axes are logarithmic. Independent samples follow the dashed line: ten "
                "times the time, a tenth of the relMSE. The lower curve is the better one.");
    }
    draw_plot(*ImGui::GetWindowDrawList(), plot, layout, hit, legend);
}

// In the column the plot needs all of its room.
void draw_legend_below(const Plot& plot) {
    const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
    for (const PlotSeries& s : plot.series) {
        const float width = em(1.1f) + ImGui::CalcTextSize(s.label.c_str()).x;
        if (&s != &plot.series.front()) {
            ImGui::SameLine(0, em(1));
            if (ImGui::GetCursorScreenPos().x + width > right) ImGui::NewLine();
        }
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::Dummy({width, ImGui::GetTextLineHeight()});
        if (!has_value(s)) ui::tip("Nothing is measured of this one: render it again.");
        draw_legend_entry(*ImGui::GetWindowDrawList(), s, {at.x, at.y});
    }
}

// The newest numbers of the shown image.
void draw_numbers(const App& app) {
    const CompareState& c = app.compare;
    CurveMaker maker = c.maker;
    if (app.snapshot && !app.snapshot->exponents.empty())
        maker.exponent = app.snapshot->exponents[shown_exponent(app)];
    const LiveCurve* curve = find_curve(c.curves, curve_label(maker));
    if (!curve || curve->points.empty()) return;
    const CurvePoint& p = curve->points.back();
    if (p.measured)
        ui::wrapped(theme::text, fmt::format("Now: relMSE {:.3g}, trimmed {:.3g},\nbias {:+.2g} %",
                                             p.measured->relmse, p.measured->relmse_trimmed,
                                             100 * p.measured->bias));
    else if (std::isfinite(p.estimate))
        ui::wrapped(theme::text, fmt::format("Now: estimated relMSE {:.3g}", p.estimate));
    ui::tip(
        fmt::format("{}, {:.3g} s, {} samples per pixel", curve->label, p.seconds, p.spp).c_str());
}

void draw_buttons(App& app) {
    CompareState& c = app.compare;
    const float third = ui::share_of_width(3);
    if (ui::wide_button(c.large_plot ? "Small" : "Large",
                        "The plot in a window of its own. [Shift+H]", third))
        c.large_plot = !c.large_plot;
    const std::string stem = app.ui.panel.files.save_name + "-error";
    ImGui::BeginDisabled(c.curves.empty());
    ImGui::SameLine();
    if (ui::wide_button("PNG", "Saves the plot as a picture.", third))
        ask(app, ActionKind::save_plot, free_name(stem, ".png"));
    ImGui::SameLine();
    if (ui::wide_button("CSV", "Saves the numbers, as midway render --error-log does.", third))
        ask(app, ActionKind::save_plot, free_name(stem, ".csv"));
    ImGui::EndDisabled();
    if (!c.dropped.empty() && c.curves.size() < 2)
        ui::note(theme::text_dim,
                 "The curves before were of another image and are gone: " + c.dropped + ".");
}

void draw_large(App& app) {
    CompareState& c = app.compare;
    const Rect& v = app.ui.view;
    const vec2 size = glm::min(v.size() * vec2(0.9f, 0.6f), vec2(em(52), em(32)));
    ImGui::SetNextWindowPos({v.upper.x - em(0.8f), v.upper.y - em(0.8f)}, ImGuiCond_Appearing,
                            {1, 1});
    ImGui::SetNextWindowSize({size.x, size.y}, ImGuiCond_Appearing);
    ImGui::SetNextWindowSizeConstraints({em(18), em(12)}, {1e5f, 1e5f});
    if (ImGui::Begin("Error over time##large", &c.large_plot,
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoFocusOnAppearing)) {
        const Plot plot = make_plot(c, c.metric);
        ImGui::TextColored(theme::text_dim, "%s", plot.title.c_str());
        const ImVec2 room = ImGui::GetContentRegionAvail();
        draw_in(plot, {std::max(room.x, em(8)), std::max(room.y, em(6))}, true);
    }
    ImGui::End();
}

}  // namespace

Change draw_error_plot(App& app) {
    CompareState& c = app.compare;
    Change change;
    const bool large = c.large_plot && app.ui.panels;
    if (large) draw_large(app);
    c.watched = large;
    if (!ui::begin_section(app, ui::Side::right, "Error over time", false)) return {};
    c.watched = true;
    change |= draw_reference(app);
    draw_metric(c);
    const Plot plot = make_plot(c, c.metric);
    draw_in(plot, {ImGui::GetContentRegionAvail().x, em(13)}, false);
    draw_legend_below(plot);
    draw_numbers(app);
    draw_buttons(app);
    ui::end_section(app);
    return change;
}

}  // namespace midway
