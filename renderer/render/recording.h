// What of a sample's contributions a film holds: which strategies, weighted or bare, clamped or
// not, as exact integers. One arithmetic for the film and for those who look at single samples.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "image/film.h"
#include "integrator/estimator.h"
#include "render/settings.h"

namespace midway {

struct Recording {
    std::vector<bool> wanted;  // by strategy_index; empty: all
    bool unweighted = false;
    float clamp = std::numeric_limits<float>::infinity();  // of the largest component

    bool wants(const Strategy& k) const { return wanted.empty() || wanted[strategy_index(k)]; }
};

Recording make_recording(const RenderSettings& settings);

// A contribution that is not finite reaches no film; it is counted.
inline bool is_usable(const Contribution& c, size_t exponents) {
    bool finite = is_finite(c.value);
    for (size_t i = 0; i < exponents; ++i) finite &= std::isfinite(c.weights[i]);
    return finite;
}

struct RecordedValue {
    vec3 value{0};
    double weight = 1;  // that it was multiplied by
    bool clamped = false;
};
inline RecordedValue recorded_value(const Recording& r, const Contribution& c, size_t exponent) {
    RecordedValue v;
    if (!r.unweighted) v.weight = c.weights[exponent];
    v.value = c.value * static_cast<float>(v.weight);
    const float largest = max_component(v.value);
    if (largest > r.clamp) {
        v.value *= r.clamp / largest;
        v.clamped = true;
    }
    return v;
}

// A component of a recorded value for the film. Large exponents make weights so small that products
// in dim scenes leave float's normal range, where workers flush: the same product is formed higher
// up, so that an image does not depend on the strength of its lights in more than a factor.
inline Int128 recorded_fixed(const Contribution& c, const RecordedValue& v, int k,
                             int unit_exponent, FixedCounts& counts) {
    if (v.value[k] >= 0x1p-100f || v.clamped) return to_fixed(v.value[k], unit_exponent, counts);
    const float lifted = c.value[k] * static_cast<float>(v.weight * 0x1p64);
    return to_fixed(lifted, unit_exponent + 64, counts);
}

inline FixedRgb to_fixed_rgb(const vec3& v, int unit_exponent, FixedCounts& counts) {
    return {to_fixed(v.x, unit_exponent, counts), to_fixed(v.y, unit_exponent, counts),
            to_fixed(v.z, unit_exponent, counts)};
}

}  // namespace midway
