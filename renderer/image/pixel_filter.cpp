#include "image/pixel_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace midway {
namespace {

constexpr int cells = 128;

double profile_value(FilterKind kind, double x, double radius) {
    if (kind == FilterKind::gaussian) {
        constexpr double sigma = 0.5;  // pixels; the tail is lifted so that it ends at zero
        const auto g = [](double d) { return std::exp(-d * d / (2 * sigma * sigma)); };
        return g(x) - g(radius);
    }
    if (kind == FilterKind::blackman_harris) {
        // Four-term window (Harris 1978).
        const double t = 2 * 3.14159265358979323846 * (x / (2 * radius) + 0.5);
        return 0.35875 - 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) -
               0.01168 * std::cos(3 * t);
    }
    return 1;
}

struct AxisChoice {
    int pixel = 0;
    float factor = 0;
};

// Among the at most four pixel centres within the radius of film coordinate x.
AxisChoice choose_on_axis(const PixelFilter& f, float x, float u) {
    if (f.values.size() == 1) return {static_cast<int>(std::floor(x)), f.values[0]};  // the box
    const int first = static_cast<int>(std::ceil(x - f.radius - 0.5f));
    const int last = static_cast<int>(std::floor(x + f.radius - 0.5f));
    // Rounding at both ends may let one pixel more in than the radius holds.
    std::array<float, 5> weights;
    const int count = std::min(last - first + 1, static_cast<int>(weights.size()));
    float sum = 0;
    for (int j = 0; j < count; ++j) sum += weights[j] = filter_value(f, x - (first + j + 0.5f));
    if (!(sum > 0)) return {};
    float left = u * sum;
    int chosen = first;
    for (int j = 0; j < count; ++j) {
        if (weights[j] > 0) chosen = first + j;
        if (left < weights[j]) break;
        left -= weights[j];
    }
    return {chosen, sum};
}

}  // namespace

PixelFilter make_filter(FilterKind kind) {
    PixelFilter f;
    f.kind = kind;
    f.radius = kind == FilterKind::box ? 0.5f : 1.5f;
    std::vector<double> weights(kind == FilterKind::box ? 1 : cells);
    for (size_t i = 0; i < weights.size(); ++i)
        weights[i] = profile_value(kind, f.radius * (2 * (i + 0.5) / weights.size() - 1), f.radius);
    f.profile = make_distribution(weights);
    for (size_t i = 0; i < weights.size(); ++i)
        f.values.push_back(static_cast<float>(f.profile.probability(i) * f.profile.size()) /
                           (2 * f.radius));
    return f;
}

vec2 sample_filter(const PixelFilter& f, const vec2& u) {
    if (f.profile.size() == 1) return f.radius * (2.0f * u - 1.0f);  // as below, at once
    const auto axis = [&](float v) {
        const DiscreteSample s = sample_discrete(f.profile, v);
        return f.radius * (2 * (s.index + s.remapped) / f.profile.size() - 1);
    };
    return {axis(u.x), axis(u.y)};
}

std::array<Float8, 2> sample_filters(const PixelFilter& f, const Float8& u, const Float8& v) {
    if (f.profile.size() == 1) return {f.radius * (2.0f * u - 1.0f), f.radius * (2.0f * v - 1.0f)};
    std::array<Float8, 2> offset{};
    for (int k = 0; k < lane_count; ++k) {
        const vec2 one = sample_filter(f, {u[k], v[k]});
        offset[0][k] = one.x;
        offset[1][k] = one.y;
    }
    return offset;
}

float filter_value(const PixelFilter& f, float x) {
    const auto cells = static_cast<float>(f.values.size());
    const float place = (x / f.radius + 1) * 0.5f * cells;
    return place >= 0 && place < cells ? f.values[static_cast<size_t>(place)] : 0;
}

SplatPixel choose_splat_pixel(const PixelFilter& f, const vec2& film, const vec2& u) {
    // A film position far outside would overflow the integer pixel.
    if (!(std::abs(film.x) < 1e6f && std::abs(film.y) < 1e6f)) return {};
    const AxisChoice x = choose_on_axis(f, film.x, u.x), y = choose_on_axis(f, film.y, u.y);
    return {x.pixel, y.pixel, x.factor * y.factor};
}

}  // namespace midway
