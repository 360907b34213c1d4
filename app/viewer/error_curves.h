// Error against render time: one curve for each technique and exponent that was tried on one image.
// Pure: points come from the error meter, in any order. Times in seconds of rendering; errors as in
// report/error_log.h.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "render/settings.h"
#include "report/error_point.h"

namespace midway {

struct CurvePoint {
    double seconds = 0, cpu_seconds = 0;
    std::uint64_t spp = 0;
    // Of relMSE, from the halves A and B of the samples; NaN at odd numbers of samples.
    double estimate = std::numeric_limits<double>::quiet_NaN();
    std::optional<ErrorPoint> measured;  // against the reference
};

// What made a curve's images.
struct CurveMaker {
    Technique technique = Technique::bdpt;
    double exponent = 2;
    SamplerKind sampler = SamplerKind::sobol;
    std::uint64_t seed = 0;
};

struct LiveCurve {
    CurveMaker maker;
    std::string label;
    std::uint64_t job = 0;  // that added to it last
    // Later ones have more seconds and more samples. All but the last stand at least
    // `curve_spacing` apart.
    std::vector<CurvePoint> points;
};

// Eight points in a factor of ten.
inline constexpr double curve_spacing = 1.333521432163324;
inline constexpr size_t most_curves = 12;

enum class ErrorMetric { relmse, trimmed, bias, estimate };

// "path", "light", "bdpt:2", "path:1", "bdpt:2, independent, seed 7": what is as usual is left out.
std::string curve_label(const CurveMaker& maker);

// Adds what was measured of a job's image. A job that goes over the same ground as the curve's last
// one (same bits after the same samples) only goes on where that ended, unless the old points lack
// what this one has: the curve then begins anew.
void add_point(std::vector<LiveCurve>& curves, const CurveMaker& maker, std::uint64_t job,
               const CurvePoint& point);

// NaN where unknown; the bias with its sign.
double value_of(const CurvePoint& point, ErrorMetric metric);

const LiveCurve* find_curve(const std::vector<LiveCurve>& curves, const std::string& label);

// As convergence.csv, and the estimate in a column of its own.
std::string curves_csv(const std::vector<LiveCurve>& curves);

}  // namespace midway
