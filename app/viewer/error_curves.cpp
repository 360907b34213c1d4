#include "error_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/error_log.h"

namespace midway {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Values that a slider passes on its way leave short curves that say nothing.
bool is_in_passing(const LiveCurve& c) {
    const double b = c.maker.exponent;
    return c.points.size() < 3 && b != 0 && b != 1 && b != 2;
}

LiveCurve& begin_curve(std::vector<LiveCurve>& curves, const CurveMaker& maker, std::uint64_t job) {
    // Exponents of the same paths belong to one job.
    std::erase_if(curves, [&](const LiveCurve& c) { return c.job != job && is_in_passing(c); });
    if (curves.size() >= most_curves) curves.erase(curves.begin());
    curves.push_back({maker, curve_label(maker), job, {}});
    return curves.back();
}

bool lacks_reference(const LiveCurve& c) {
    return std::any_of(c.points.begin(), c.points.end(),
                       [](const CurvePoint& p) { return !p.measured; });
}

void add_to(std::vector<CurvePoint>& points, const CurvePoint& p) {
    const size_t n = points.size();
    if (n > 0 && p.spp == points.back().spp) {
        if (p.measured) points.back().measured = p.measured;
        return;
    }
    if (n > 0 && (p.spp < points.back().spp || p.seconds <= points.back().seconds)) return;
    // The newest point moves on until it is far enough from the one before.
    if (n > 1 && points[n - 1].seconds < points[n - 2].seconds * curve_spacing)
        points.back() = p;
    else
        points.push_back(p);
}

}  // namespace

std::string curve_label(const CurveMaker& m) {
    std::string label(to_string(m.technique));
    // Light tracing has one way to make each path: nothing to weigh.
    const bool usual = m.technique == Technique::path || m.technique == Technique::automatic;
    const bool weighs = m.technique == Technique::bdpt || (usual && m.exponent != 2);
    if (weighs) label += fmt::format(":{:.4g}", m.exponent);
    if (m.sampler != SamplerKind::sobol) label += fmt::format(", {}", to_string(m.sampler));
    if (m.seed != 0) label += fmt::format(", seed {}", m.seed);
    return label;
}

void add_point(std::vector<LiveCurve>& curves, const CurveMaker& maker, std::uint64_t job,
               const CurvePoint& point) {
    const std::string label = curve_label(maker);
    const auto found = std::find_if(curves.begin(), curves.end(),
                                    [&](const LiveCurve& c) { return c.label == label; });
    LiveCurve& c = found != curves.end() ? *found : begin_curve(curves, maker, job);
    if (c.job != job && point.measured && lacks_reference(c)) c.points.clear();
    c.job = job;
    add_to(c.points, point);
}

double value_of(const CurvePoint& p, ErrorMetric metric) {
    if (metric == ErrorMetric::estimate) return p.estimate;
    if (!p.measured) return unknown;
    if (metric == ErrorMetric::relmse) return p.measured->relmse;
    return metric == ErrorMetric::trimmed ? p.measured->relmse_trimmed : p.measured->bias;
}

const LiveCurve* find_curve(const std::vector<LiveCurve>& curves, const std::string& label) {
    for (const LiveCurve& c : curves)
        if (c.label == label) return &c;
    return nullptr;
}

std::string curves_csv(const std::vector<LiveCurve>& curves) {
    std::string text = error_csv_header();
    text.insert(text.size() - 1, ",relmse_estimated");
    for (const LiveCurve& c : curves)
        for (const CurvePoint& p : c.points) {
            ErrorPoint e{p.seconds, p.cpu_seconds, p.spp};
            e.mse = e.rmse = e.relmse = e.relmse_trimmed = e.smape = e.bias = e.bias_z = unknown;
            std::string row = error_csv_row(std::string(to_string(c.maker.technique)),
                                            c.maker.exponent, c.maker.seed, p.measured.value_or(e));
            row.insert(row.size() - 1,
                       std::isfinite(p.estimate) ? fmt::format(",{}", p.estimate) : ",");
            text += row;
        }
    return text;
}

}  // namespace midway
