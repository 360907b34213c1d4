#include "report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "image/file.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t longest_list = 100000;

float quantile(std::vector<float> values, double share) {
    const auto place =
        static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())) - 1);
    const auto nth = values.begin() + std::max<std::ptrdiff_t>(place, 0);
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

Json summary(const std::vector<float>& values) {
    if (values.empty()) return {{"count", 0}};
    return {{"count", values.size()},
            {"median", quantile(values, 0.5)},
            {"p95", quantile(values, 0.95)},
            {"max", *std::max_element(values.begin(), values.end())}};
}

}  // namespace

Mark mark_now(App& app) {
    app.timings.frames.clear();
    app.timings.edit_to_image.clear();
    app.timings.stops.clear();
    Mark mark;
    if (app.snapshot) {
        mark.samples = double(app.snapshot->passes);
        mark.job = app.snapshot->job;
    }
    return mark;
}

void write_report(const std::string& path, const App& app, const Mark& mark) {
    const Mark now;
    const double wall = std::chrono::duration<double>(now.time - mark.time).count();
    Json j;
    j["scene"] = app.document.path;
    j["error"] = app.document.error;
    j["warnings"] = app.document.warnings;
    j["notice"] = app.ui.notice;
    j["first_pixels"] = app.timings.first_pixels;
    j["frames"] = summary(app.timings.frames);
    j["edit_to_image"] = summary(app.timings.edit_to_image);
    j["stops"] = summary(app.timings.stops);
    j["seconds"] = wall;
    j["cpu_seconds"] = now.cpu_seconds - mark.cpu_seconds;
    if (app.snapshot) {
        const Snapshot& s = *app.snapshot;
        j["job"] = s.job;
        j["scale"] = s.scale;
        j["size"] = {s.width, s.height};
        j["spp"] = s.passes;
        j["finished"] = s.finished;
        j["exponents"] = s.exponents;
        j["seconds_render"] = s.seconds;
        j["samples_per_second"] =
            s.seconds > 0 ? double(s.passes) * s.crop.area() / s.seconds : 0.0;
        j["rays_closest"] = s.statistics.rays.closest;
        j["rays_shadow"] = s.statistics.rays.shadow;
    }
    atomic_write(path, j.dump(2) + "\n");
}

void note_time(std::vector<float>& list, double seconds) {
    if (list.size() >= longest_list) list.erase(list.begin(), list.begin() + longest_list / 2);
    list.push_back(static_cast<float>(seconds));
}

}  // namespace midway
