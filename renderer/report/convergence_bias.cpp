#include "report/convergence_bias.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/statistics.h"
#include "math/student.h"

namespace midway {
namespace {

std::string verdict_text(const BiasVerdict& v, const BiasTest& test) {
    if (std::isnan(v.z)) return "not tested: too few halves, or no light";
    const std::string figures =
        fmt::format("{:+.3g} % of the mean ({:+.3g} to {:+.3g} %), z = {:.1f}", 100 * v.bias.value,
                    100 * v.bias.lower, 100 * v.bias.upper, v.z);
    if (std::abs(v.z) <= v.limit) return figures + ": no bias found";
    if (v.expected) return figures + ": differs, as it must: " + test.excuse.why;
    return figures + fmt::format(": BIASED (|z| above {:.2f}), or the reference is", v.limit);
}

}  // namespace

BiasVerdict judge_bias(const BiasTest& test) {
    BiasVerdict v;
    v.limit =
        normal_limit(sidak_level(bias_false_alarm, std::max<std::int64_t>(1, test.comparisons)));
    const double mean = test.reference.estimate.mean;
    RunningMean m;
    for (const double l : test.luminances)
        if (!std::isnan(l)) m.add(l / mean - 1);
    if (m.count > 0 && mean != 0) v.bias.value = m.mean;
    const double own = sqr(m.estimate().standard_error);
    const bool known = test.reference.freedom > 0;
    const double reference = known ? sqr(test.reference.estimate.standard_error / mean) : own;
    const double square = own + reference;
    if (m.count >= 2 && square > 0 && std::isfinite(square)) {
        double freedom = double(m.count - 1);
        if (known)
            freedom = sqr(square) / (sqr(own) / freedom + sqr(reference) / test.reference.freedom);
        const double half = student_limit(0.05, freedom) * std::sqrt(square);
        v.bias.lower = v.bias.value - half;
        v.bias.upper = v.bias.value + half;
        v.z = normal_deviate_of_student(v.bias.value / std::sqrt(square), freedom);
        v.expected = v.z > v.limit    ? test.excuse.bright
                     : v.z < -v.limit ? test.excuse.dark
                                      : test.excuse.bright || test.excuse.dark;
        v.flagged = !v.expected && std::abs(v.z) > v.limit;
    }
    v.text = verdict_text(v, test);
    return v;
}

}  // namespace midway
