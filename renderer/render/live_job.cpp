#include "render/live_job.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace midway {
namespace {

// Before anything is known: dearer than most scenes are, so that the first image is soon there.
constexpr double cautious_cost = 40e-6;
// Where an image is nearly empty, samples cost next to nothing; the next view may be full.
constexpr double least_cost = 0.3e-6;

int divided_up(int a, int b) { return (a + b - 1) / b; }

PixelRect whole_crop(const RenderSettings& s) {
    return s.crop.value_or(PixelRect{0, 0, s.width, s.height});
}

double pixels_at(const LiveJob& job, int scale) {
    const PixelRect crop = whole_crop(job.settings);
    return std::ceil(double(crop.width()) / scale) * std::ceil(double(crop.height()) / scale);
}

}  // namespace

int thread_count(const LiveJob& job) {
    const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return job.threads > 0 ? job.threads : processors;
}

ScaledView scaled_view(const LiveJob& job, int scale) {
    ScaledView v{job.camera, job.settings, {}};
    const PixelRect crop = whole_crop(job.settings);
    if (scale <= 1) {
        v.placement = {double(crop.x0), double(crop.y0), double(crop.x1), double(crop.y1)};
        return v;
    }
    // The coarse image is as large or a little larger, has the same centre, and its pixels are
    // `scale` times as large to the last digit: nothing moves when the scale changes.
    RenderSettings& s = v.settings;
    s.width = divided_up(job.settings.width, scale);
    s.height = divided_up(job.settings.height, scale);
    v.camera.yfov = 2 * std::atan(std::tan(job.camera.yfov / 2) * s.height * scale /
                                  std::max(1, job.settings.height));
    const double left = 0.5 * (job.settings.width - double(s.width) * scale);
    const double top = 0.5 * (job.settings.height - double(s.height) * scale);
    const auto first = [&](int x, double origin) {
        return static_cast<int>(std::floor((x - origin) / scale));
    };
    const auto end = [&](int x, double origin) {
        return static_cast<int>(std::ceil((x - origin) / scale));
    };
    PixelRect c{first(crop.x0, left), first(crop.y0, top), end(crop.x1, left), end(crop.y1, top)};
    c = {std::max(c.x0, 0), std::max(c.y0, 0), std::min(c.x1, s.width), std::min(c.y1, s.height)};
    s.crop.reset();
    if (job.settings.crop) s.crop = c;
    v.placement = {left + double(c.x0) * scale, top + double(c.y0) * scale,
                   left + double(c.x1) * scale, top + double(c.y1) * scale};
    return v;
}

void LiveCost::learn(Technique technique, double thread_seconds, double samples) {
    if (!(samples > 0) || !(thread_seconds > 0)) return;
    const double seen = std::max(least_cost, thread_seconds / samples);
    double& known = per_sample_[static_cast<size_t>(technique)];
    // A late image is worse than a coarse one: believe at once what got dearer.
    known = known > 0 && seen < known ? 0.5 * (known + seen) : seen;
}

double LiveCost::expected_seconds(const LiveJob& job, int threads, int scale) const {
    double cost = per_sample_[static_cast<size_t>(job.settings.technique)];
    if (cost == 0) cost = cautious_cost;
    return cost * pixels_at(job, scale) / std::max(1, threads);
}

int LiveCost::fitting_scale(const LiveJob& job, int threads, double seconds) const {
    const double ratio = expected_seconds(job, threads, 1) / seconds;
    // No image need be coarser than a dozen pixels across.
    const int coarsest = std::max(1, std::min(job.settings.width, job.settings.height) / 12);
    int scale = std::clamp(static_cast<int>(std::sqrt(std::max(1.0, ratio))), 1, coarsest);
    while (scale < coarsest && expected_seconds(job, threads, scale) > seconds) ++scale;
    return scale;
}

}  // namespace midway
