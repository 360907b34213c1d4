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

}  // namespace

float srgb_from_linear(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    if (linear <= 0.0031308f) return 12.92f * linear;
    return 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

vec3 tone_map(const vec3& linear, const ToneMap& tone) {
    const float scale = std::exp2(tone.exposure_ev);
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
