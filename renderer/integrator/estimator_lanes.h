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

// What one strategy found in each lane.
struct FoundLanes {
    Mask8 lanes{};
    Strategy strategy;
    Vec3x8 value;
    Double8 weight;
};

// Next event from the camera vertices in `lanes` (t = 1), with next event's numbers.
template <Facts F>
FoundLanes connect_to_lights(const Estimator& e, const VertexLanes& camera,
                             const std::array<Float8, 4>& u, RayCounts& rays);

// Connections of each camera vertex to the light vertex `shift` lanes on (s, t >= 2).
template <Facts F>
FoundLanes connect(const Estimator& e, const VertexLanes& camera, const VertexLanes& light,
                   int shift, RayCounts& rays);

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
    StoredVertex camera;             // the camera walks' last vertex, or of light walks not kept
    std::deque<StoredVertex> light;  // vertices 1, 2, ... of the group's light subpaths
    int light_vertices = 0;          // how many there are

    StoredVertex& next_light_vertex() {
        if (light.size() == static_cast<size_t>(light_vertices)) light.emplace_back();
        return light[static_cast<size_t>(light_vertices++)];
    }
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
        StoredVertex& vertex = keep ? s.next_light_vertex() : s.camera;
        rays.closest += static_cast<std::uint64_t>(std::popcount(bits(w.active)));
        extend<F>(e, w, vertex);
        const VertexLanes& v = vertex.lanes;
        if (any(v.connectible) && e.splats(v.index + 1) && record.wants({1, v.index + 1}))
            record_found(e, connect_to_camera<F>(e, v, w.numbers.second, rays), record);
        if (w.index == e.max_bounces || !any(w.surface)) return;
        scatter(e, v, w);
    }
}

// Every connection from the group's camera vertices of one number.
template <Facts F, class Record>
void connect_to_subpaths(const Estimator& e, const VertexLanes& v, EstimatorLanes& s,
                         Record& record, RayCounts& rays) {
    const int last = std::min(s.light_vertices, e.max_bounces - v.index);
    for (int j = 1; j <= last; ++j) {
        if (!record.wants({v.index + 1, j + 1})) continue;
        const VertexLanes& l = s.light[static_cast<size_t>(j) - 1].lanes;
        record_found(e, connect<F>(e, v, l, partner(0, v.index, j, lane_count), rays), record);
    }
}

// As trace_camera_subpath().
template <Facts F, class Record>
void trace_camera_subpaths(const Estimator& e, const PixelGroup& g, std::uint64_t pass,
                           EstimatorLanes& s, Record& record, RayCounts& rays) {
    WalkLanes& w = s.walk;
    const VertexLanes& v = s.camera.lanes;
    rays.camera_paths += lane_count;
    start_camera_walks(e, g.x0, g.y, pass, w);
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
            if constexpr (!F.path_tracer) connect_to_subpaths<F>(e, v, s, record, rays);
        }
        if (has_found_all(e, w.index)) return;
        scatter(e, v, w);
    }
}

// As estimate(), for a whole group.
template <Facts F, class Record, class GoOn>
bool estimate_lanes(const Estimator& e, const PixelGroup& g, std::uint64_t pass, EstimatorLanes& s,
                    Record& record, RayCounts& rays, const GoOn& go_on) {
    s.light_vertices = 0;
    record.begin_group(g, pass);
    if constexpr (!F.path_tracer) {
        if (e.families.needs_light_subpaths()) {
            auto numbers = paired_subpaths(e, g.x0, g.y, lane_count, pass);
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
