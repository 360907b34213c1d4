#include "display_maths.h"

#include "comparison.h"
#include "strategy_view.h"

namespace midway {
namespace {

// From shadow to glare; neighbours differ in hue and in lightness.
constexpr vec3 ramp[] = {{0.06f, 0.04f, 0.14f}, {0.20f, 0.14f, 0.44f}, {0.13f, 0.33f, 0.62f},
                         {0.08f, 0.52f, 0.58f}, {0.20f, 0.66f, 0.42f}, {0.58f, 0.76f, 0.26f},
                         {0.94f, 0.76f, 0.22f}, {0.94f, 0.49f, 0.17f}, {0.86f, 0.21f, 0.22f},
                         {1.00f, 0.93f, 0.93f}};

// Blue below zero, orange above; zero is nearly black, so that noise does not hide in grey. Told
// apart by those who do not tell red from green.
constexpr vec3 signed_colours[] = {
    {0.72f, 0.90f, 1.00f}, {0.36f, 0.70f, 0.98f}, {0.16f, 0.47f, 0.88f}, {0.10f, 0.29f, 0.62f},
    {0.07f, 0.15f, 0.31f}, {0.05f, 0.05f, 0.05f}, {0.31f, 0.14f, 0.05f}, {0.60f, 0.28f, 0.06f},
    {0.86f, 0.45f, 0.10f}, {0.97f, 0.67f, 0.26f}, {1.00f, 0.90f, 0.66f}};

vec3 ramp_at(std::span<const vec3> colours, float x) {
    const auto last = static_cast<int>(colours.size()) - 1;
    const float p = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(last);
    const auto i = static_cast<size_t>(std::min(static_cast<int>(p), last - 1));
    return glm::mix(colours[i], colours[i + 1], p - static_cast<float>(i));
}

vec3 stops(const DisplayMaths& m, float light) {
    if (!(light > 0)) return vec3(0);
    return ramp_at(ramp, (std::log2(light) - m.range.x) / (m.range.y - m.range.x));
}

vec3 object_colour(float number) {
    if (number <= 0) return vec3(0);
    return vec3(0.25f) +
           0.65f * glm::fract(number * vec3(0.6180339887f, 0.7548776662f, 0.5698402910f));
}

// Estimated standard error of each pixel's luminance, relative to it; a floor of a hundredth of the
// mean keeps black from being divided by.
std::shared_ptr<const Image> relative_error(const Image& image, const Image& variance) {
    double sum = 0;
    for (const vec3& c : image.pixels) sum += luminance(c);
    const auto floor =
        static_cast<float>(0.01 * sum / double(std::max<size_t>(1, image.pixels.size())));
    auto error = std::make_shared<Image>(image.width, image.height);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        error->pixels[i] = vec3(luminance_error(variance.pixels[i]) /
                                std::max(luminance(image.pixels[i]) + floor, 1e-30f));
    }
    return error;
}

vec2 depth_range(const Image& depth) {
    vec2 range(std::numeric_limits<float>::max(), 0);
    for (const vec3& d : depth.pixels)
        if (d.x > 0) range = {std::min(range.x, d.x), std::max(range.y, d.x)};
    return range.y > range.x ? range : vec2(range.y * 0.5f, range.y + 1e-6f);
}

const Image* channel_of(const AovImages& aovs, Channel channel) {
    switch (channel) {
        case Channel::albedo:
            return &aovs.albedo;
        case Channel::normal:
            return &aovs.normal;
        case Channel::depth:
            return &aovs.depth;
        case Channel::object:
            return &aovs.object;
        default:
            return nullptr;
    }
}

// Albedo, normal, depth, object.
void show_channel(const App& app, ShownImage& shown) {
    if (!app.channels) return;
    const ChannelSnapshot& c = *app.channels;
    const Image* image = channel_of(c.images, app.display.channel);
    if (!image || image->pixels.empty()) return;
    shown.image = std::shared_ptr<const Image>(app.channels, image);
    shown.placement = c.placement;
    shown.scale = c.scale;
    switch (app.display.channel) {
        case Channel::normal:
            shown.maths.mode = DisplayMode::normal;
            break;
        case Channel::object:
            shown.maths.mode = DisplayMode::object;
            break;
        case Channel::depth:
            shown.maths.mode = DisplayMode::depth;
            shown.maths.range = depth_range(*image);
            break;
        default:
            shown.maths.mode = DisplayMode::encoded;
            break;
    }
}

void show_error(const Snapshot& s, size_t exponent, ShownImage& shown) {
    if (exponent >= s.variances.size() || !s.variances[exponent]) return;
    shown.image = relative_error(*s.images[exponent], *s.variances[exponent]);
    shown.maths.mode = DisplayMode::stops;
    shown.maths.range = error_stops;
}

// All pixels of an image have the same number of samples.
void show_samples(const Snapshot& s, ShownImage& shown) {
    auto image = std::make_shared<Image>(1, 1);
    image->pixels[0] = vec3(static_cast<float>(s.passes) / static_cast<float>(s.scale * s.scale));
    shown.image = image;
    shown.placement = {double(s.crop.x0), double(s.crop.y0), double(s.crop.x1), double(s.crop.y1)};
    shown.maths.mode = DisplayMode::stops;
    shown.maths.range = sample_stops;
}

}  // namespace

float luminance_error(const vec3& variance) {
    // As if the three errors were one: they are nearly, a sample being too bright in all.
    return luminance(glm::sqrt(glm::max(variance, vec3(0))));
}

std::span<const vec3> stop_ramp() { return ramp; }
std::span<const vec3> signed_ramp() { return signed_colours; }

ShownImage shown_image(const App& app) {
    ShownImage shown;
    if (!app.snapshot || app.snapshot->images.empty()) return shown;
    const Snapshot& s = *app.snapshot;
    const DisplayChoices& d = app.display;
    const size_t exponent = std::min(shown_exponent(app), s.images.size() - 1);
    shown.placement = s.placement;
    shown.crop = s.crop;
    shown.scale = s.scale;
    switch (d.channel) {
        case Channel::image:
            shown.image = s.images[exponent];
            shown.maths.curve = d.curve;
            shown.maths.scale = std::exp2(d.exposure_ev);
            if (d.false_colour) {
                shown.maths.mode = DisplayMode::stops;
                shown.maths.range = {d.stop_low, d.stop_high};
            }
            show_comparison(app, shown);
            show_strategies(app, shown);
            break;
        case Channel::error:
            show_error(s, exponent, shown);
            break;
        case Channel::samples:
            show_samples(s, shown);
            break;
        default:
            show_channel(app, shown);
            break;
    }
    return shown;
}

vec3 shown_colour(const DisplayMaths& m, const vec3& v) {
    switch (m.mode) {
        case DisplayMode::tone:
            return tone_map(v * m.scale, {0, m.curve});
        case DisplayMode::stops:
            return stops(m, luminance(v) * m.scale);
        case DisplayMode::encoded:
            return tone_map(v, {});
        case DisplayMode::normal:
            return length_squared(v) > 0 ? 0.5f * v + 0.5f : vec3(0);
        case DisplayMode::depth: {
            const float x = std::clamp((v.x - m.range.x) / (m.range.y - m.range.x), 0.0f, 1.0f);
            return vec3(v.x > 0 ? glm::mix(0.95f, 0.1f, x) : 0.0f);
        }
        case DisplayMode::object:
            return object_colour(v.x);
        default:
            return vec3(0);
    }
}

vec3 difference_colour(const DisplayMaths& m, float difference) {
    return ramp_at(signed_colours, (difference * m.scale - m.range.x) / (m.range.y - m.range.x));
}

Image shown_colours(const ShownImage& shown) {
    if (shown.other) return compared_colours(shown);
    Image encoded(shown.image->width, shown.image->height);
    for (size_t i = 0; i < encoded.pixels.size(); ++i)
        encoded.pixels[i] = shown_colour(shown.maths, shown.image->pixels[i]);
    return encoded;
}

}  // namespace midway
