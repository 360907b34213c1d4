// Which light subpaths a camera subpath meets. Samples of neighbouring pixels share theirs.
//
// The first rough surface of a camera walk weighs its connections to the vertices of all of them
// and chooses two (choice.h), one to a first vertex and one to a later one: that is where most of
// what connections carry comes from, and what makes them noisy is which light vertices lie near.
//
// Behind it a vertex chooses one connection in all. It weighs one to each vertex j, as if there
// were one light subpath, but takes vertex j from another neighbour's for each pair (i, j):
// connections to one and the same light subpath would be bright or dark together, and their errors
// would add up. Densities are those of one light subpath, since any of them is as independent of
// the camera sample as its own.
//
// (Davidovic, Krivanek, Hasan and Slusallek 2014, "Progressive light transport simulation on the
// GPU", decouple them too: each camera vertex draws light vertices from those of a whole pass.)
#pragma once

#include <algorithm>
#include <vector>

#include "integrator/walk.h"
#include "math/hash.h"

namespace midway {

// At which place of a group of `count` samples the light subpath belongs whose vertex j is
// connected to vertex i of the camera sample at `place`: its own for i = j = 1. Every light vertex
// is met once for each i. Along either subpath, eight vertices in a row meet eight different ones.
inline int partner(int place, int i, int j, int count) {
    return (place + (i - 1) + 3 * (j - 1)) % count;
}

// Calls `use` with the place of every light subpath whose vertex j the camera vertex weighs.
template <class Use>
void for_each_partner(const PathVertex& camera, int place, int j, int count, const Use& use) {
    if (camera.rough > 0) return use(partner(place, camera.index, j, count));
    for (int from = 0; from < count; ++from) use(from);
}

// Calls `use` with the first and the last number of the light vertices among which a camera vertex
// makes a choice; `first`: for walks at their first rough surface.
template <class Use>
void for_each_choice(bool first, int last, const Use& use) {
    if (last < 1) return;
    use(1, first ? 1 : last);
    if (first && last > 1) use(2, last);
}

// What a camera vertex makes its choice with among light vertices from number j on.
inline double choice_number(const SampleKey& key, int index, int j) {
    return double(hash_combine(walk_coin(key, index), 0x63686f6f7365 + j) >> 11) * 0x1p-53;
}

// Connectible surface vertices of one light subpath, nearest to the light first.
using LightSubpath = std::vector<PathVertex>;

// Vertex j; null where there is none that can be connected.
inline const PathVertex* vertex_at(const LightSubpath& light, int j) {
    // Those before it may be missing, so that it is not behind place j - 1.
    for (size_t k = std::min(light.size(), static_cast<size_t>(j)); k-- > 0;)
        if (light[k].index <= j) return light[k].index == j ? &light[k] : nullptr;
    return nullptr;
}

// Those of a group; kept by each worker so that nothing is allocated per sample.
struct LightSubpaths {
    std::array<LightSubpath, group_pixels> of;  // by the place of the sample they belong to
    LightSubpath spare;                         // one that nothing connects to
    int count = 0;                              // samples in the group
    int longest = 0;                            // highest index of a vertex

    void begin(int samples) {
        for (LightSubpath& l : of) l.clear();
        count = samples;
        longest = 0;
    }
};

}  // namespace midway
