// The estimator of estimator.h for a whole group of pixels at once, its eight samples side by side:
// the same walks, strategies and weights with the same bits, in half the instructions. It serves
// the passes that have code of their own (facts.h: one exponent, 2); lists of exponents, groups at
// the end of a row, and whoever looks at a single sample take estimator.h.
//
// Where the scalar code returns early, a lane leaves the mask of those that go on. What is rare or
// of many kinds (lamps that are hit, textures, lobes other than Lambert's, near lamps, lights
// without an area) is done lane by lane by the scalar functions.
#pragma once

#include <deque>

#include "integrator/estimator.h"
#include "integrator/walk_lanes.h"

namespace midway {

// What one strategy found in each lane; connections, of strategies with different t.
struct FoundLanes {
    Mask8 lanes{};
    int s = 0;
    Mask8 t{};
    Vec3x8 value{};
    Double8 weight{};

    Strategy strategy(int lane) const { return {s, t[lane]}; }
};
inline FoundLanes nothing_of(const Strategy& k) {
    FoundLanes f;
    f.s = k.s;
    f.t = Mask8{} + k.t;
    return f;
}

// Vertices 1, 2, ... of a group's light subpaths.
struct LightVertices {
    std::deque<StoredVertex> kept;
    int count = 0;

    StoredVertex& next() {
        if (kept.size() == static_cast<size_t>(count)) kept.emplace_back();
        return kept[static_cast<size_t>(count++)];
    }
    const VertexLanes& vertex(int j) const { return kept[static_cast<size_t>(j) - 1].lanes; }
};

inline Mask8 at_first_rough(const VertexLanes& camera, bool first) {
    return first ? camera.rough == 0 : camera.rough != 0;
}

// Next event from the camera vertices in `lanes` (t = 1), with next event's numbers.
template <Facts F>
FoundLanes connect_to_lights(const Estimator& e, const VertexLanes& camera,
                             const std::array<Float8, 4>& u, RayCounts& rays);

// The connections that camera vertices chose (s, t >= 2), and where their rays go.
struct ConnectionLanes {
    FoundLanes found;
    RayLanes edges;
};
// Among those to light vertices j .. last, in lanes that are (`first`) at the first rough surfaces
// of their walks, or that are not.
template <Facts F>
ConnectionLanes choose_connections(const Estimator& e, const VertexLanes& camera, bool first,
                                   const Double8& numbers, const LightVertices& light, int j,
                                   int last);

// Traces the rays of what was found; lanes that are blocked are no longer found.
void let_arrive(const Estimator& e, FoundLanes& found, const RayLanes& edges, RayCounts& rays);

// Light tracing from the light vertices (s = 1), with the pixels they are splatted to.
struct SplatLanes {
    FoundLanes found;
    std::array<SplatPixel, lane_count> pixels;
};
template <Facts F>
SplatLanes connect_to_camera(const Estimator& e, const VertexLanes& light,
                             const std::array<Float8, 4>& u, RayCounts& rays);

// Lights, or the sky, that the camera walks reached (t = 0).
template <Facts F>
FoundLanes hit_lights(const Estimator& e, const WalkLanes& walk, const VertexLanes& vertex);

// What a lane found, as the scalar estimator would say it.
Contribution contribution_of(const FoundLanes& found, int lane, int sample);

// Kept by each worker so that nothing is allocated per sample.
struct EstimatorLanes {
    WalkLanes walk;
    StoredVertex camera;  // the camera walks' last vertex, or of light walks not kept
    LightVertices light;
};

// Hands what was found, if anything, to the record, which is as in estimator.h, and besides has
//   void contributions(const FoundLanes&, int sample)   to the samples' own pixels
//   void splats(const SplatLanes&)
//   void begin_group(const PixelGroup&, std::uint64_t pass), void end_group()
template <class Record>
void record_found(const Estimator& e, const FoundLanes& f, Record& record, int sample = 0) {
    if (!any(f.lanes)) return;
    e.at(Work::film);
    record.contributions(f, sample);
    e.at(Work::shading);
}
template <class Record>
void record_found(const Estimator& e, const SplatLanes& s, Record& record) {
    if (!any(s.found.lanes)) return;
    e.at(Work::film);
    record.splats(s);
    e.at(Work::shading);
}

// As trace_light_subpath(): lane k walks subpath numbers[k].
template <Facts F, class Record>
void trace_light_subpaths(const Estimator& e, const std::array<std::uint64_t, lane_count>& numbers,
                          std::uint64_t pass, bool keep, EstimatorLanes& s, Record& record,
                          RayCounts& rays) {
    WalkLanes& w = s.walk;
    for (const std::uint64_t n : numbers) rays.light_paths += n < e.light_subpaths;
    start_light_walks(e, numbers, pass, w);
    while (any(w.active) && w.index < e.max_bounces) {
        StoredVertex& vertex = keep ? s.light.next() : s.camera;
        rays.closest += static_cast<std::uint64_t>(std::popcount(bits(w.active)));
        extend<F>(e, w, vertex);
        const VertexLanes& v = vertex.lanes;
        if (any(v.connectible) && e.splats(v.index + 1) && record.wants({1, v.index + 1}))
            record_found(e, connect_to_camera<F>(e, v, w.numbers.second, rays), record);
        if (w.index == e.max_bounces || !any(w.surface)) return;
        scatter(e, v, w);
    }
}

// Every connection from the group's camera vertices of one number, as for_each_choice() has them
// for those that are `first`, or that are not.
template <Facts F, class Record>
void connect_to_subpaths(const Estimator& e, const VertexLanes& v, bool first, EstimatorLanes& s,
                         Record& record, RayCounts& rays) {
    for_each_choice(first, std::min(s.light.count, e.max_bounces - v.index), [&](int j, int last) {
        Double8 numbers;
        for (int k = 0; k < lane_count; ++k)
            numbers.set(k, choice_number(s.walk.keys[k], v.index, j));
        ConnectionLanes c = choose_connections<F>(e, v, first, numbers, s.light, j, last);
        for_each_lane(c.found.lanes, [&](int k) {
            if (!record.wants(c.found.strategy(k))) c.found.lanes[k] = 0;
        });
        if (!any(c.found.lanes)) return;
        let_arrive(e, c.found, c.edges, rays);
        record_found(e, c.found, record);
    });
}

// As trace_camera_subpath().
template <Facts F, class Record>
void trace_camera_subpaths(const Estimator& e, const PixelGroup& g, std::uint64_t pass,
                           EstimatorLanes& s, Record& record, RayCounts& rays) {
    WalkLanes& w = s.walk;
    const VertexLanes& v = s.camera.lanes;
    rays.camera_paths += lane_count;
    start_camera_walks(e, g, pass, w);
    while (any(w.active)) {
        rays.closest += static_cast<std::uint64_t>(std::popcount(bits(w.active)));
        extend<F>(e, w, s.camera);
        if (record.wants({w.index + 1, 0})) record_found(e, hit_lights<F>(e, w, v), record);
        if (!any(w.surface) || w.index > e.max_bounces) return;

        if (any(v.connectible)) {
            if (e.families.next_event && record.wants({v.index + 1, 1}))
                for_each_next_event(e, v.index, w.numbers.second, [&](const auto& u, int i) {
                    record_found(e, connect_to_lights<F>(e, v, u, rays), record, i);
                });
            if constexpr (!F.path_tracer)
                for (const bool first : {true, false})
                    if (any(v.connectible & at_first_rough(v, first)))
                        connect_to_subpaths<F>(e, v, first, s, record, rays);
        }
        if (has_found_all(e, w.index)) return;
        scatter(e, v, w);
    }
}

// As estimate(), for a whole group.
template <Facts F, class Record, class GoOn>
bool estimate_lanes(const Estimator& e, const PixelGroup& g, std::uint64_t pass, EstimatorLanes& s,
                    Record& record, RayCounts& rays, const GoOn& go_on) {
    s.light.count = 0;
    record.begin_group(g, pass);
    if constexpr (!F.path_tracer) {
        if (e.families.needs_light_subpaths()) {
            auto numbers = paired_subpaths(e, g, pass);
            const auto some_left = [&] {
                return *std::min_element(numbers.begin(), numbers.end()) < e.light_subpaths;
            };
            for (bool first = true; some_left(); first = false) {
                if (!go_on()) return false;
                trace_light_subpaths<F>(e, numbers, pass, first && e.families.connection, s, record,
                                        rays);
                for (std::uint64_t& n : numbers) n += static_cast<std::uint64_t>(e.crop.area());
            }
        }
    }
    if (!go_on()) return false;
    trace_camera_subpaths<F>(e, g, pass, s, record, rays);
    e.at(Work::film);
    record.end_group();
    e.at(Work::other);
    return true;
}

}  // namespace midway
