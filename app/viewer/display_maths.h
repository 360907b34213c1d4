// How the numbers of a snapshot become colours: which image is shown, and the arithmetic that
// shaders/display.frag does on the screen and shown_colour() for PNG files. Stops are powers of
// two.
#pragma once

#include <memory>
#include <span>

#include "state.h"

namespace midway {

// In the order of shaders/display.frag.
enum class DisplayMode { tone, stops, encoded, normal, depth, object };

struct DisplayMaths {
    DisplayMode mode = DisplayMode::tone;
    Curve curve = Curve::srgb;
    float scale = 1;   // on the values: exposure
    vec2 range{0, 1};  // of stops, or of depths
    bool operator==(const DisplayMaths&) const = default;
};

// What is shown of a snapshot: numbers, their place in the whole image, and how they are drawn.
struct ShownImage {
    std::shared_ptr<const Image> image;  // null: nothing to show
    ImagePlacement placement;
    PixelRect crop;  // of the whole image; beyond it nothing is shown
    int scale = 1;   // pixels of the whole image in one of `image`
    DisplayMaths maths;
};

ShownImage shown_image(const App& app);

// Encoded, in [0, 1].
vec3 shown_colour(const DisplayMaths& maths, const vec3& value);
Image shown_colours(const ShownImage& shown);

// Standard error of a pixel's luminance, given the variance of its colours.
float luminance_error(const vec3& variance);

// Range of the scales that the channels `error` and `samples` are shown on.
inline constexpr vec2 error_stops{-10, 1}, sample_stops{0, 16};

// The colours of DisplayMode::stops, evenly spaced.
std::span<const vec3> stop_ramp();

}  // namespace midway
