// How the image is shown. Nothing here touches the render.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/view.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

constexpr std::array<ui::Choice, 7> channels = {{
    {"Image", "What is rendered. [V] goes through the channels."},
    {"Albedo", "Approximate share of light that the first surface reflects."},
    {"Normal",
     "Shading normal of the first surface, in the file's axes; red +x, green +y, blue +z."},
    {"Depth", "Distance of the first surface along the view axis; near is bright."},
    {"Object", "Every object in a colour of its own."},
    {"Error",
     "Estimated error of each pixel relative to its brightness, from the difference of the "
     "two independent halves of the samples."},
    {"Samples", "Samples that each pixel has had."},
}};

Change draw_exposure(App& app) {
    Change change;
    DisplayChoices& d = app.display;
    ui::row("Exposure",
            "In stops (EV): +1 doubles the brightness. [[] and []], with Shift in small "
            "steps. Ctrl+click to type.");
    ImGui::SetNextItemWidth(-ui::em(4.4f));
    if (ImGui::SliderFloat("##exposure", &d.exposure_ev, -10, 10, "%+.2f EV")) {
        d.auto_exposure = false;
        d.exposure_ev = std::clamp(d.exposure_ev, -30.0f, 30.0f);
        change.display = true;
    }
    ImGui::SameLine();
    if (ImGui::Checkbox("Auto", &d.auto_exposure)) change.display = true;
    ui::tip("The exposure follows the image, so that its log-average is middle grey. [X]");
    constexpr std::array<ui::Choice, 3> curves = {{
        {"Linear", "No curve: the sRGB encoding alone, clipped at white. For measuring by eye."},
        {"Filmic", "A soft shoulder: highlights roll off like on film."},
        {"AgX", "Bright colours go to white without a change of hue."},
    }};
    ui::row("Tone curve", "How light becomes what the screen can show. [T]");
    int curve = static_cast<int>(d.curve);
    if (ui::segmented("curve", curves, curve)) {
        d.curve = static_cast<Curve>(curve);
        change.display = true;
    }
    return change;
}

Change draw_false_colour(App& app) {
    Change change;
    DisplayChoices& d = app.display;
    if (ImGui::Checkbox("False colour", &d.false_colour)) change.display = true;
    ui::tip("Luminance as a colour scale in stops; the legend stands below the image. [C]");
    if (d.false_colour) {
        ImGui::SameLine(ui::em(8));
        ImGui::SetNextItemWidth(-1);
        if (ImGui::DragFloatRange2("##stops", &d.stop_low, &d.stop_high, 0.05f, -30, 30, "%.1f",
                                   "%.1f"))
            change.display = true;
        ui::tip("Lowest and highest luminance of the scale, in stops (powers of two).");
        d.stop_high = std::max(d.stop_high, d.stop_low + 0.5f);
    }
    return change;
}

Change draw_channels(App& app) {
    Change change;
    ui::row("Channel", "What of the image is shown. [V]");
    const auto chosen = static_cast<size_t>(app.display.channel);
    if (ImGui::BeginCombo("##channel", channels[chosen].label)) {
        for (size_t i = 0; i < channels.size(); ++i) {
            if (ImGui::Selectable(channels[i].label, i == chosen)) {
                app.display.channel = static_cast<Channel>(i);
                change.display = true;
            }
            ui::tip(channels[i].tooltip);
        }
        ImGui::EndCombo();
    }
    ui::tip(channels[chosen].tooltip);
    return change;
}

Change draw_zoom(App& app) {
    Change change;
    DisplayChoices& d = app.display;
    ui::row("Zoom", "Of the image's pixels, not of the camera: Ctrl+wheel and Ctrl+drag. [Z]");
    struct Step {
        const char* label;
        float zoom;
    };
    const float one = 1 / app.ui.pixels_per_point;
    const std::array<Step, 4> steps = {
        {{"Fit", 0}, {"1:1", one}, {"4:1", 4 * one}, {"32:1", 32 * one}}};
    constexpr std::array<ui::Choice, 4> choices = {{
        {"Fit", "As large as the view allows. [Z]"},
        {"1:1", "One pixel of the image on one of the screen. [Z]"},
        {"4:1", "Every pixel as a square of four."},
        {"32:1", "Large enough to read the pixels' values."},
    }};
    int chosen = -1;
    for (size_t i = 0; i < steps.size(); ++i)
        if (d.zoom == steps[i].zoom) chosen = static_cast<int>(i);
    if (ui::segmented("zoom", choices, chosen)) {
        const float wanted = steps[static_cast<size_t>(chosen)].zoom;
        if (wanted == 0) {
            d.zoom = 0;
            d.pan = vec2(0);
        } else {
            zoom_about(app, (app.ui.view.lower + app.ui.view.upper) * 0.5f,
                       wanted / zoom_in_use(app));
            d.zoom = wanted;
        }
        change.display = true;
    }
    if (chosen < 0)
        ui::wrapped(theme::text_dim, fmt::format("now {:.3g}:1", zoom_in_use(app) / one));
    if (ImGui::Checkbox("Values in large pixels", &d.pixel_values)) change.display = true;
    ui::tip("Writes linear red, green and blue into every pixel that is large enough.");
    return change;
}

}  // namespace

Change draw_display(App& app) {
    if (!ui::begin_section(app, ui::Side::right, "Display", true)) return {};
    Change change = draw_exposure(app);
    change |= draw_channels(app);
    change |= draw_false_colour(app);
    change |= draw_zoom(app);
    ui::end_section(app);
    return change;
}

}  // namespace midway
