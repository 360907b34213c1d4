#include "image/tonemap.h"

namespace midway {
namespace {

// The value below which `fraction` of the values lie. Reorders them.
float percentile(std::vector<float>& values, double fraction) {
    auto nth = values.begin() +
               static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

float filmic(float x) {
    x = std::min(std::max(x, 0.0f), 1e6f);  // the curve's squares must not overflow
    return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
}

// x / (1 + x^(3/2))^(2/3): slope one at 0, and one at infinity.
float hyperbola(float x) { return x / std::pow(1 + std::pow(x, 1.5f), 2.0f / 3); }

// The scale of the hyperbola that leaves the pivot with slope 2 and rises by `height` over `width`.
float hyperbola_scale(float width, float height) {
    return 2 * width / std::pow(std::pow(2 * width / height, 1.5f) - 1, 2.0f / 3);
}

float agx_sigmoid(float x) {
    constexpr float pivot_x = 10 / 16.5f;
    const float pivot_y = srgb_from_linear(0.18f);
    if (x < pivot_x) {
        const float s = hyperbola_scale(pivot_x, pivot_y);
        return pivot_y - s * hyperbola(2 * (pivot_x - x) / s);
    }
    const float s = hyperbola_scale(1 - pivot_x, 1 - pivot_y);
    return pivot_y + s * hyperbola(2 * (x - pivot_x) / s);
}

}  // namespace

vec3 agx(const vec3& exposed) {
    // How much red, green and blue add to X + Y + Z in white (BT.709, D65): what mixing with white
    // in the plane of chromaticities means for linear light.
    constexpr vec3 white{0.2120f, 0.3922f, 0.3958f};
    vec3 c;
    for (int i = 0; i < 3; ++i) c[i] = exposed[i] > 0 ? std::min(exposed[i], 1e6f) : 0.0f;
    c = 0.8f * c + vec3(0.2f * glm::dot(white, c));
    vec3 encoded;
    for (int i = 0; i < 3; ++i) {
        const float stops = std::log2(std::max(c[i], 1e-10f) / 0.18f);
        encoded[i] = agx_sigmoid(std::clamp((stops + 10) / 16.5f, 0.0f, 1.0f));
    }
    return encoded;
}

float srgb_from_linear(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    if (linear <= 0.0031308f) return 12.92f * linear;
    return 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

vec3 tone_map(const vec3& linear, const ToneMap& tone) {
    const float scale = std::exp2(tone.exposure_ev);
    if (tone.curve == Curve::agx) return agx(linear * scale);
    vec3 encoded(0);
    for (int i = 0; i < 3; ++i) {
        float exposed = linear[i] * scale;
        if (tone.curve == Curve::filmic && !std::isnan(exposed)) exposed = filmic(exposed);
        encoded[i] = srgb_from_linear(exposed);
    }
    return encoded;
}

float auto_exposure(const Image& image) {
    std::vector<float> shining;
    for (const vec3& p : image.pixels) {
        float l = luminance(p);
        if (std::isfinite(l) && l > 0) shining.push_back(l);
    }
    if (shining.empty()) return 0;
    const float background = percentile(shining, 0.99) / 4096;
    std::erase_if(shining, [&](float l) { return l < background; });
    const float low = percentile(shining, 0.05);
    const float high = percentile(shining, 0.99);

    // Sum in the order of the pixels: the order that nth_element leaves is not specified.
    double sum = 0;
    int64_t count = 0;
    for (const vec3& p : image.pixels) {
        float l = luminance(p);
        if (!(l >= low && l <= high)) continue;
        sum += std::log2(l);
        ++count;
    }
    return static_cast<float>(std::log2(0.18) - sum / static_cast<double>(count));
}

}  // namespace midway
