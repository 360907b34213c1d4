// Random walks of eight samples side by side: walk.h for a whole group of pixels at once, with the
// same bits for each. All walks of a group are at the same vertex number; those that have ended
// stay behind as lanes that are not `active`.
#pragma once

#include "integrator/mis_lanes.h"
#include "integrator/walk.h"
#include "scene/surface_lanes.h"

namespace midway {

static_assert(group_pixels == lane_count);

// Surface vertices of eight subpaths, one in each lane, as PathVertex has them.
struct VertexLanes {
    SurfaceLanes surface;
    Vec3x8 to_previous, throughput;
    mis::State8 mis;
    int index = 0;
    Mask8 rough{};  // as in Walk
    Mask8 connectible{};
};

// With what its lanes point to: a copy would point into the original.
struct StoredVertex {
    VertexLanes lanes;
    BsdfStore store;

    StoredVertex() = default;
    StoredVertex(const StoredVertex&) = delete;
    StoredVertex& operator=(const StoredVertex&) = delete;
};

struct WalkLanes {
    Transport transport = Transport::radiance;
    Mask8 active{};
    std::array<SampleKey, lane_count> keys;
    Vec3x8 origin, direction;  // of the rays
    Vec3x8 throughput;
    Float8 roulette_reference;

    // Of the scattering at the previous vertices (or the start).
    Vec3x8 previous_position;
    Float8 pdf_fwd_w, pdf_rev_w, cos_previous;
    Mask8 delta{};

    // Starts of light subpaths.
    std::array<int, lane_count> lights{};
    Float8 light_origin, light_leave;  // LightPdfs
    Mask8 infinite_light{}, hittable_light{};

    int index = 0;
    Mask8 rough{};        // as in Walk
    HitLanes hits;        // of the rays traced last
    Mask8 surface{};      // lanes that stand on a surface
    Mask8 sky{};          // lanes whose ray left the scene just now
    mis::State8 mis;      // at the vertices reached last, or at infinity
    NumberLanes numbers;  // as VertexNumbers: scatter, connect
};

// Estimator::count() of a strategy for the exponent of lanes; `first`: where its last camera vertex
// is the first rough surface.
inline Double8 count_in_lanes(const Estimator& e, const Strategy& k, const Mask8& first) {
    return select(first, all_lanes(e.count(k, 0, true)), all_lanes(e.count(k, 0, false)));
}

// Of a whole group.
void start_camera_walks(const Estimator& e, const PixelGroup& g, std::uint64_t pass, WalkLanes& w);

// Lane k walks subpath numbers[k]; lanes whose number is not below e.light_subpaths have none.
void start_light_walks(const Estimator& e, const std::array<std::uint64_t, lane_count>& numbers,
                       std::uint64_t pass, WalkLanes& w);

// Traces the active walks to their next vertices.
template <Facts F>
void extend(const Estimator& e, WalkLanes& w, StoredVertex& vertex);

// Chooses where the walks go on from their vertices; those that end are no longer active.
void scatter(const Estimator& e, const VertexLanes& vertex, WalkLanes& w);

}  // namespace midway
