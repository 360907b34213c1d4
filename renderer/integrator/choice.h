// One of many candidates, drawn as they come by with a probability in proportion to what each would
// contribute: a reservoir of one (Chao 1982, "A general purpose unequal probability sampling
// plan"). So a vertex is connected to one of many light vertices, which all were weighed, at the
// price of one ray (Popov, Ramamoorthi, Durand and Drettakis 2015, "Probabilistic connections for
// bidirectional path tracing"): what differs among them is no noise but for what blocks the ray.
#pragma once

#include "math/lanes.h"

namespace midway {

// Number is double, or Double8 for a choice in each lane.
template <class Number>
struct Choice {
    Number rest{};   // uniform in [0, 1), whatever was drawn so far
    Number total{};  // of all importances
    Number drawn{};  // importance of the candidate that was drawn last

    // Whether the next candidate takes the place of the one drawn before. One without importance
    // changes nothing; one that is not finite is taken, so that somebody sees it.
    auto offer(const Number& importance) {
        const auto counts = not_zero(importance);
        // Infinity becomes not a number, which is never smaller.
        const Number x = importance + (importance - importance), sum = total + x;
        const Number mark = select(counts, rest * sum, x);
        const auto takes = not_at_least(mark, x);
        const Number renewed = select(takes, mark, mark - x) / select(takes, x, total);
        rest = select(counts, renewed, rest);
        drawn = select(takes, x, drawn);
        total = sum;
        return takes;
    }

    // One over the probability of what was drawn: what makes up for all the others.
    Number factor() const { return total / drawn; }
};

// A candidate's importance: what it would add to the image, in units of 2^-300, lest small
// weights in dim scenes leave double's range.
inline double importance_of(const vec3& value, double weight) {
    return (double(value.x) + double(value.y) + double(value.z)) * (weight * 0x1p300);
}
inline Double8 importance_of(const Vec3x8& value, const Double8& weight) {
    return (to_double(value.x) + to_double(value.y) + to_double(value.z)) *
           (weight * all_lanes(0x1p300));
}

}  // namespace midway
