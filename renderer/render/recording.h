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
    bool clamped = false;
};
inline RecordedValue recorded_value(const Recording& r, const Contribution& c, size_t exponent) {
    RecordedValue v;
    v.value = r.unweighted ? c.value : c.value * static_cast<float>(c.weights[exponent]);
    const float largest = max_component(v.value);
    if (largest > r.clamp) {
        v.value *= r.clamp / largest;
        v.clamped = true;
    }
    return v;
}

inline FixedRgb to_fixed_rgb(const vec3& v, int unit_exponent, FixedCounts& counts) {
    return {to_fixed(v.x, unit_exponent, counts), to_fixed(v.y, unit_exponent, counts),
            to_fixed(v.z, unit_exponent, counts)};
}

}  // namespace midway
