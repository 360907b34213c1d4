#include "view.h"

namespace midway {
namespace {

constexpr float closest_zoom = 256, farthest_zoom = 1.0f / 16;

vec2 image_size(const App& app) {
    if (app.snapshot && app.snapshot->width > 0) return {app.snapshot->width, app.snapshot->height};
    return {app.render.settings.width, app.render.settings.height};
}

float fitting_zoom(const App& app) {
    const vec2 room = app.ui.view.size() / image_size(app);
    const float fit = std::max(std::min(room.x, room.y), farthest_zoom);
    // Nearly one pixel to one is meant to be one: rounding must not blur the image.
    const float pixel = 1 / app.ui.pixels_per_point;
    return std::abs(fit / pixel - 1) < 0.01f ? pixel : fit;
}

}  // namespace

float zoom_in_use(const App& app) {
    return app.display.zoom > 0 ? app.display.zoom : fitting_zoom(app);
}

Rect image_rect(const App& app) {
    const vec2 size = image_size(app) * zoom_in_use(app);
    const vec2 centre = 0.5f * (app.ui.view.lower + app.ui.view.upper) +
                        (app.display.zoom > 0 ? app.display.pan : vec2(0));
    // On whole pixels of the screen, so that image pixels fall on them too.
    const float pixels = app.ui.pixels_per_point;
    const vec2 lower = glm::round((centre - 0.5f * size) * pixels) / pixels;
    return {lower, lower + size};
}

vec2 image_position(const App& app, vec2 screen) {
    return (screen - image_rect(app).lower) / zoom_in_use(app);
}

vec2 screen_position(const App& app, vec2 image) {
    return image_rect(app).lower + image * zoom_in_use(app);
}

std::optional<ivec2> pixel_at(const App& app, vec2 screen) {
    if (!app.ui.view.contains(screen)) return {};
    const vec2 p = image_position(app, screen), size = image_size(app);
    if (p.x < 0 || p.y < 0 || p.x >= size.x || p.y >= size.y) return {};
    return ivec2(p);
}

void zoom_about(App& app, vec2 screen, float factor) {
    const vec2 held = image_position(app, screen);
    const vec2 centre = 0.5f * (app.ui.view.lower + app.ui.view.upper);
    app.display.zoom = std::clamp(zoom_in_use(app) * factor, farthest_zoom, closest_zoom);
    app.display.pan = screen - centre + (0.5f * image_size(app) - held) * app.display.zoom;
}

}  // namespace midway
