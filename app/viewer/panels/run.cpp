// Run control: pause, restart, where to stop, which part of the image.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

constexpr int max_side = 16384;

struct Size {
    const char* name;
    int width, height;
};
constexpr std::array<Size, 6> sizes = {{{"512 x 512", 512, 512},
                                        {"1024 x 1024", 1024, 1024},
                                        {"1280 x 720", 1280, 720},
                                        {"1920 x 1080", 1920, 1080},
                                        {"2560 x 1440", 2560, 1440},
                                        {"3840 x 2160", 3840, 2160}}};

Change set_size(App& app, int width, int height) {
    RenderSettings& s = app.render.settings;
    width = std::clamp(width, 1, max_side);
    height = std::clamp(height, 1, max_side);
    if (s.width == width && s.height == height) return {};
    s.width = width;
    s.height = height;
    s.crop.reset();
    return {.settings = true};
}

Change fit_to_view(App& app) {
    const vec2 size = app.ui.view.size() * app.ui.pixels_per_point;
    return set_size(app, static_cast<int>(size.x), static_cast<int>(size.y));
}

Change draw_resolution(App& app) {
    Change change;
    RenderSettings& s = app.render.settings;
    ui::row("Resolution",
            "Pixels of the image. With \"As the window\" it follows the window's size.");
    const std::string shown = app.render.fit_window ? std::string("As the window")
                                                    : fmt::format("{} x {}", s.width, s.height);
    if (ImGui::BeginCombo("##resolution", shown.c_str())) {
        if (ImGui::Selectable("As the window", app.render.fit_window)) {
            app.render.fit_window = true;
            change |= fit_to_view(app);
        }
        for (const Size& size : sizes)
            if (ImGui::Selectable(size.name, !app.render.fit_window && s.width == size.width &&
                                                 s.height == size.height)) {
                app.render.fit_window = false;
                change |= set_size(app, size.width, size.height);
            }
        ImGui::EndCombo();
    }
    ui::row("", "");
    int typed[2] = {s.width, s.height};
    if (ImGui::InputInt2("##size", typed, ImGuiInputTextFlags_EnterReturnsTrue)) {
        app.render.fit_window = false;
        change |= set_size(app, typed[0], typed[1]);
    }
    ui::tip("Width and height in pixels; Enter applies them.");
    return change;
}

Change draw_region(App& app) {
    Change change;
    RenderSettings& s = app.render.settings;
    ui::row("Region", "Only this rectangle of the image is rendered; the samples go there.");
    const bool picking = app.ui.panel.navigation.tool == ViewTool::region;
    const float width = s.crop ? ui::share_of_width(2) : ui::share_of_width(1);
    if (ui::wide_button(picking  ? "Drag in the image"
                        : s.crop ? "Change"
                                 : "Drag a region",
                        "Then drag a rectangle over the image; Esc gives up. [Shift+R]", width))
        choose_tool(app, ViewTool::region);
    if (s.crop) {
        ImGui::SameLine();
        if (ui::wide_button("Whole", "Renders the whole image again", width)) {
            s.crop.reset();
            change.settings = true;
        }
        ui::wrapped(theme::text_dim, fmt::format("{} x {} pixels from ({}, {})", s.crop->width(),
                                                 s.crop->height(), s.crop->x0, s.crop->y0));
    }
    return change;
}

}  // namespace

Change restart(App&) { return {.settings = true}; }

Change draw_run(App& app) {
    if (!ui::begin_section(app, ui::Side::left, "Run", true)) return {};
    Change change;
    const float half = ui::share_of_width(2);
    if (ui::wide_button(app.render.paused ? "Go on" : "Pause",
                        "The workers sleep; the image and the samples so far stay. [Space]", half))
        app.render.paused = !app.render.paused;
    ImGui::SameLine();
    if (ui::wide_button("Restart", "Forgets the samples so far and begins again. [R]", half))
        change |= restart(app);
    // The limits act on the render that runs; nothing begins again.
    ui::optional_int("Samples", "Stop when every pixel has so many samples.", app.render.limits.spp,
                     256, "Samples per pixel; Enter applies them.");
    ui::optional_number("Seconds", "Stop after so many seconds of rendering.",
                        app.render.limits.seconds, 60, "%.6g");
    change |= draw_resolution(app);
    change |= draw_region(app);
    ui::end_section(app);
    return change;
}

}  // namespace midway
