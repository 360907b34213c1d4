// What is known of a pass before it begins and is worth code of its own. The estimator's functions
// are templates over Facts; each gives the same bits for all Facts that hold, and no_facts always
// do. Passes with one exponent, 2, take eight samples at a time (estimator_lanes.h). Kept are those
// facts alone that save a per cent (tests/README.md, "Speed, measured").
#pragma once

namespace midway {

struct Estimator;

struct Facts {
    // The only exponent is 2: no list to go through, and no choice among heuristics at every
    // weight.
    bool one_power2 = false;
    // No light subpaths, in the image or in the weights: what is left is a path tracer, whose
    // weights set next event against emitter hits and nothing else.
    bool path_tracer = false;

    bool operator==(const Facts&) const = default;
};

// The instances of the estimator that there are, compiled at the ends of walk.cpp,
// estimator.cpp and their likes for lanes.
inline constexpr Facts no_facts{};
inline constexpr Facts power2_facts{.one_power2 = true};
inline constexpr Facts path_tracer_facts{.one_power2 = true, .path_tracer = true};

// Of the instances the one that knows most of what holds.
Facts facts_of(const Estimator& estimator);

// Calls use.operator()<F>() with F = facts, as facts_of() gives them.
template <class Use>
auto with_facts(const Facts& facts, const Use& use) {
    if (facts == path_tracer_facts) return use.template operator()<path_tracer_facts>();
    if (facts == power2_facts) return use.template operator()<power2_facts>();
    return use.template operator()<no_facts>();
}

}  // namespace midway
