// How the numbers of a snapshot become colours: which image is shown, and the arithmetic that
// shaders/display.frag does on the screen and shown_colour() for PNG files. Stops are powers of
// two.
#pragma once

#include <memory>
#include <span>

#include "state.h"

namespace midway {

// In the order of shaders/display.frag.
// difference and relative are those of two images' luminances, B - A and (B - A) / A.
enum class DisplayMode { tone, stops, encoded, normal, depth, object, difference, relative };

struct DisplayMaths {
    DisplayMode mode = DisplayMode::tone;
    Curve curve = Curve::srgb;
    float scale = 1;   // on the values: exposure
    vec2 range{0, 1};  // of stops, depths or differences
    float floor = 0;   // below A^2 in a relative difference: (B - A) / sqrt(A^2 + floor)
    bool operator==(const DisplayMaths&) const = default;
};

// What is shown of a snapshot: numbers, their place in the whole image, and how they are drawn.
struct ShownImage {
    std::shared_ptr<const Image> image;  // null: nothing to show
    ImagePlacement placement;
    PixelRect crop;  // of the whole image; beyond it nothing is shown
    int scale = 1;   // pixels of the whole image in one of `image`; 0: no whole number
    DisplayMaths maths;
    // A, where `image`, B, is compared with it: beside it left of `wipe` (a column of the whole
    // image), or subtracted from it where maths.mode says so. Always at scale 1.
    std::shared_ptr<const Image> other;
    PixelRect other_place;
    float wipe = 0;
    bool differs() const {
        return maths.mode == DisplayMode::difference || maths.mode == DisplayMode::relative;
    }
};

ShownImage shown_image(const App& app);

// Encoded, in [0, 1].
vec3 shown_colour(const DisplayMaths& maths, const vec3& value);
vec3 difference_colour(const DisplayMaths& maths, float difference);
Image shown_colours(const ShownImage& shown);

// Standard error of a pixel's luminance, given the variance of its colours.
float luminance_error(const vec3& variance);

// B - A of the luminances, or relative to A.
float shown_difference(const DisplayMaths& maths, const vec3& b, const vec3& a);

// What is seen at a pixel of the whole image; nothing beyond what is compared.
struct SeenPixel {
    vec3 value{0}, colour{0};  // a difference in value.x
};
std::optional<SeenPixel> seen_pixel(const ShownImage& shown, const ivec2& pixel);

// Range of the scales that the channels `error` and `samples` are shown on.
inline constexpr vec2 error_stops{-10, 1}, sample_stops{0, 16};

// The colours of DisplayMode::stops, evenly spaced.
std::span<const vec3> stop_ramp();
// Those of differences, from below zero to above.
std::span<const vec3> signed_ramp();

}  // namespace midway
