// Where the image lies on the screen: zoom and pan in, rectangles and pixels out.
#pragma once

#include <optional>

#include "state.h"

namespace midway {

// Zoom in use, screen points per image pixel: display.zoom, or what makes the image fit the view.
float zoom_in_use(const App& app);

// The screen rectangle that the whole image covers; larger than the view where zoomed in.
Rect image_rect(const App& app);

// Continuous position on the image (pixels of the full-size image, y downwards) under a point of
// the screen; perhaps outside of the image.
vec2 image_position(const App& app, vec2 screen);
vec2 screen_position(const App& app, vec2 image);

// The pixel under a point of the screen; empty outside of the view or of the image.
std::optional<ivec2> pixel_at(const App& app, vec2 screen);

// Zooms by `factor` and keeps what is under `screen` in place.
void zoom_about(App& app, vec2 screen, float factor);

}  // namespace midway
