// The line below: how far the image is, how fast, how wrong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/error_log.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

std::string duration(double seconds) {
    if (seconds < 60) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long long>(seconds);
    if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
    return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

// Estimated relative error of the image: the root of the relMSE that is expected against the truth.
// At most some 2^16 pixels, evenly spread, are looked at. Known at even numbers of passes.
std::optional<double> estimated_error(const Image& image, const Image& variance,
                                      std::uint64_t passes) {
    const size_t step = std::max<size_t>(1, image.pixels.size() >> 16);
    const auto relmse = estimate_relmse(image, variance, pass_counts(0, passes), step);
    if (!relmse || !std::isfinite(*relmse)) return {};
    return std::sqrt(*relmse);
}

std::optional<double> error_of(App& app) {
    const Snapshot& s = *app.snapshot;
    StatusCache& cache = app.ui.panel.status;
    if (cache.of == &s && cache.job == s.job && cache.passes == s.passes &&
        cache.exponent == app.render.exponent)
        return cache.error;
    const bool goes_on = cache.job == s.job && cache.exponent == app.render.exponent;
    const std::optional<double> before = goes_on ? cache.error : std::nullopt;
    cache = {&s, s.job, s.passes, app.render.exponent, before};
    if (s.passes % 2 == 1) return before;
    const auto at = std::find(s.exponents.begin(), s.exponents.end(), app.render.exponent);
    const auto i = static_cast<size_t>(at == s.exponents.end() ? 0 : at - s.exponents.begin());
    if (i < s.images.size() && i < s.variances.size() && s.images[i] && s.variances[i])
        cache.error = estimated_error(*s.images[i], *s.variances[i], s.passes);
    return cache.error;
}

std::string error_text(double error) {
    if (error >= 0.995) return fmt::format("error ~{:.0f} %", 100 * std::min(error, 1e4));
    return fmt::format("error ~{:.2g} %", 100 * error);
}

// A cell of fixed width, so that numbers do not push each other about. True where it was clicked.
bool cell(const theme::Color& color, const std::string& text, const char* tooltip, float width) {
    const float x = ImGui::GetCursorPosX();
    ImGui::TextColored(color, "%s", text.c_str());
    const bool clicked = ImGui::IsItemClicked();
    ui::tip(tooltip);
    ImGui::SameLine();
    ImGui::SetCursorPosX(
        x + std::max(ui::em(width), ImGui::CalcTextSize(text.c_str()).x + ui::em(0.8f)));
    return clicked;
}

const char* state_in_words(const App& app, const Snapshot& s) {
    if (s.finished) return "done";
    if (app.render.paused || s.paused) return "paused";
    return "rendering";
}

void draw_cells(App& app) {
    const Snapshot& s = *app.snapshot;
    const RenderSettings& settings = app.render.settings;
    const theme::Color& technique_color =
        settings.technique == Technique::light ? theme::light : theme::camera;
    constexpr const char* names[] = {"Path", "Light", "BDPT", "Auto"};
    const char* name = names[static_cast<size_t>(settings.technique)];
    cell(technique_color, fmt::format("{}, b = {:.3g}", name, app.render.exponent),
         "Technique and exponent of the MIS weights", 7);
    cell(theme::text, state_in_words(app, s), "Space pauses, R begins again", 5.2f);
    if (s.scale > 1) {
        cell(theme::light, fmt::format("1/{} resolution", s.scale),
             "While things change, fewer and larger pixels keep the image quick", 8);
    } else {
        cell(theme::text, ui::short_number(static_cast<double>(s.passes)) + " spp",
             "Samples that every pixel has had", 5);
    }
    cell(theme::text, duration(s.seconds), "Time spent rendering this image", 4.6f);
    const std::optional<double> error = s.scale == 1 ? error_of(app) : std::nullopt;
    cell(
        theme::text, error ? error_text(*error) : "error -",
        "Estimated relative error: the root of the relMSE that is expected against the truth, from "
        "the difference of the two independent halves of the samples",
        7);
    cell(theme::text_dim, ui::short_number(s.samples_per_second) + " samples/s",
         "Pixel samples a second, all threads together", 8.2f);
    cell(theme::text_dim, ui::short_number(s.rays_per_second) + " rays/s",
         "Rays a second, all threads together, shadow rays included", 7.4f);
    cell(theme::text_dim, fmt::format("{} x {}", s.width, s.height), "Pixels of the image", 6);
    if (s.statistics.nonfinite.count == 0) return;
    if (cell(
            theme::error, fmt::format("{} not finite", s.statistics.nonfinite.count),
            "Samples whose value was not a number; they are counted and left out. Click to inspect "
            "the first of them.",
            6))
        inspect_nonfinite(app);
}

}  // namespace

Change draw_status(App& app) {
    if (!app.ui.panels) return {};
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const float top = app.ui.panel.dock[3];
    ImGui::SetNextWindowPos({0, top});
    ImGui::SetNextWindowSize({size.x, size.y - top});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui::em(0.7f), ui::em(0.15f)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, theme::rgb(0x1c1c1c));
    ImGui::Begin("##status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
    ImGui::AlignTextToFramePadding();
    if (app.snapshot && app.snapshot->error.empty()) {
        draw_cells(app);
    } else {
        ImGui::TextColored(theme::text_dim, "%s",
                           app.document.loading.empty() ? "nothing is rendered" : "loading");
        ImGui::SameLine();
    }
    const char* keys = "F1 keys";
    const float width = ImGui::CalcTextSize(keys).x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(size.x - width - ui::em(0.7f));
    if (ui::wide_button(keys, "Shows all keys and what the mouse does", width))
        app.ui.keys = !app.ui.keys;
    ImGui::End();
    return {};
}

}  // namespace midway
