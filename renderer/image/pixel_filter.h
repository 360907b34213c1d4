// Pixel filters by importance sampling: a camera sample's offset from its pixel's centre is drawn
// in proportion to the filter, so every sample weighs the same; a splat at a film position goes to
// one of the pixels it is felt in, chosen in proportion to the filter. Both use one tabulated
// profile per axis, hence the same filter to the last bit.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "math/distribution.h"
#include "math/lanes.h"

namespace midway {

enum class FilterKind : std::uint8_t { box, gaussian, blackman_harris };

struct PixelFilter {
    FilterKind kind = FilterKind::box;
    float radius = 0.5f;        // pixels
    Distribution1D profile;     // cells over [-radius, radius]
    std::vector<float> values;  // filter_value() of each cell
};

PixelFilter make_filter(FilterKind kind);

// Offset from the pixel's centre, in pixels.
vec2 sample_filter(const PixelFilter& filter, const vec2& u);

// The same for eight, each axis by itself.
std::array<Float8, 2> sample_filters(const PixelFilter& filter, const Float8& u, const Float8& v);

// One axis of the filter at distance x, per pixel; its integral is one.
float filter_value(const PixelFilter& filter, float x);

// The pixel that a splat goes to and the factor it is multiplied by (the sum of the filter over all
// pixels that feel it). May lie outside of the image. factor is 0 where no pixel feels it.
struct SplatPixel {
    int x = 0, y = 0;
    float factor = 0;
};
SplatPixel choose_splat_pixel(const PixelFilter& filter, const vec2& film, const vec2& u);

}  // namespace midway
