// Which light subpaths a camera subpath meets. Samples of neighbouring pixels share theirs: a
// camera sample connects each pair of vertices (i, j) once, as if it had one light subpath, but
// takes vertex j from another neighbour's for each pair. Connections to one and the same light
// subpath would be bright or dark together, and their errors would add up. Densities and weights
// are those of one light subpath, since any of them is as independent of the camera sample as its
// own. (Davidovic, Krivanek, Hasan and Slusallek 2014, "Progressive light transport simulation on
// the GPU", decouple them too: each camera vertex draws light vertices from those of a whole pass.)
#pragma once

#include <algorithm>
#include <vector>

#include "integrator/walk.h"

namespace midway {

// The pixels that share: a run of one row of the crop, as many as group_pixels but for the last run
// of a row.
struct PixelGroup {
    int x0 = 0, x1 = 0, y = 0;  // x1 excluded
    int size() const { return x1 - x0; }
};
inline PixelGroup group_of(const PixelRect& crop, int x, int y) {
    const int x0 = x - (x - crop.x0) % group_pixels;
    return {x0, std::min(x0 + group_pixels, crop.x1), y};
}

// At which place of a group of `count` samples the light subpath belongs whose vertex j is
// connected to vertex i of the camera sample at `place`: its own for i = j = 1. Every light vertex
// is met once for each i. Along either subpath, eight vertices in a row meet eight different ones.
inline int partner(int place, int i, int j, int count) {
    return (place + (i - 1) + 3 * (j - 1)) % count;
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
