// The estimators: `path`, `light` and `bdpt` of any exponent are one estimator with different
// families of strategies (README, "The method"). A sample is a camera subpath together with a light
// subpath, and
//   s >= 2, t = 0   the camera walk hits a light         (seed, case 2)
//   s >= 2, t = 1   next event                           (case 3)
//   s = 1,  t >= 2  light tracing, splatted              (case 4)
//   s >= 2, t >= 2  connection                           (case 1)
//
// Record is any type with
//   void contribution(const Contribution&)   added to the sample's own pixel
//   void splat(int x, int y, const Contribution&)
//   bool wants(const Strategy&)              false: the strategy's rays need not be traced
// F holds for the estimator (facts.h): it changes the code and no result.
#pragma once

#include <algorithm>
#include <vector>

#include "integrator/walk.h"

namespace midway {

// What one strategy found for one path: its unweighted estimate of the pixel's value, and the MIS
// weight for every exponent.
struct Contribution {
    Strategy strategy;
    vec3 value{0};
    std::array<double, max_exponents> weights;
};

struct RayCounts {
    std::uint64_t closest = 0, shadow = 0, camera_paths = 0, light_paths = 0;
    // Shadow rays by strategy, where somebody asks (indexed by strategy_index; what has no place
    // of its own shares the last one).
    std::vector<std::uint64_t>* by_strategy = nullptr;

    void count_shadow(const Strategy& k) {
        ++shadow;
        if (by_strategy) ++(*by_strategy)[std::min(strategy_index(k), by_strategy->size() - 1)];
    }
};

// Surface vertices of one light subpath; kept by each worker so that nothing is allocated per
// sample.
using LightSubpath = std::vector<PathVertex>;

// Next event from the camera vertex (t = 1); empty where nothing arrives.
template <Facts F = no_facts>
std::optional<Contribution> connect_to_light(const Estimator& e, const PathVertex& camera,
                                             const vec4& u, RayCounts& rays);

// Connection of two surface vertices (s, t >= 2).
template <Facts F = no_facts>
std::optional<Contribution> connect(const Estimator& e, const PathVertex& camera,
                                    const PathVertex& light, RayCounts& rays);

// Light tracing from a light vertex (s = 1), with the pixel it is splatted to.
struct Splat {
    int x = 0, y = 0;
    Contribution contribution;
};
template <Facts F = no_facts>
std::optional<Splat> connect_to_camera(const Estimator& e, const PathVertex& light, const vec4& u,
                                       RayCounts& rays);

// The camera walk reached a light, or the sky (t = 0).
template <Facts F = no_facts>
std::optional<Contribution> hit_light(const Estimator& e, const Walk& walk, Reached reached);

// Walks the light subpath; its connectible vertices are splatted and kept, where families ask for
// it.
template <Facts F = no_facts, class Record>
void trace_light_subpath(const Estimator& e, std::uint64_t subpath, std::uint64_t pass,
                         LightSubpath& vertices, Record& record, RayCounts& rays) {
    vertices.clear();
    ++rays.light_paths;
    std::optional<Walk> walk = start_light_walk(e, subpath, pass);
    while (walk && walk->index < e.max_bounces) {
        ++rays.closest;
        if (extend<F>(e, *walk) != Reached::surface) return;
        const PathVertex& v = walk->vertex;
        if (v.connectible) {
            if (e.splats(v.index + 1) && record.wants({1, v.index + 1}))
                if (const auto s = connect_to_camera<F>(e, v, walk->numbers.connect, rays)) {
                    e.at(Work::film);
                    record.splat(s->x, s->y, s->contribution);
                    e.at(Work::shading);
                }
            if (e.families.connection) vertices.push_back(v);
        }
        if (walk->index == e.max_bounces || !scatter(*walk)) return;
    }
}

// Whether a camera walk has nothing left to find behind its vertex of that number.
inline bool has_found_all(const Estimator& e, int index) {
    // Without emitter hits the last edge would find nothing.
    const bool last = index == e.max_bounces && !e.families.emitter_hit;
    const bool only_lamps =
        !e.families.emitter_hit && !e.families.next_event && !e.families.connection;
    return last || only_lamps;
}

// Hands a contribution, if there is one, to the sample's own pixel.
template <class Record>
void record_own(const Estimator& e, const std::optional<Contribution>& c, Record& record) {
    if (!c) return;
    e.at(Work::film);
    record.contribution(*c);
    e.at(Work::shading);
}

// Walks the camera subpath and forms every strategy that ends on it.
template <Facts F = no_facts, class Record>
void trace_camera_subpath(const Estimator& e, int x, int y, std::uint64_t pass,
                          const LightSubpath& light, Record& record, RayCounts& rays) {
    ++rays.camera_paths;
    Walk walk = start_camera_walk(e, x, y, pass);
    for (;;) {
        ++rays.closest;
        const Reached reached = extend<F>(e, walk);
        const Strategy hit{walk.index + 1, 0};
        if (record.wants(hit)) record_own(e, hit_light<F>(e, walk, reached), record);
        if (reached != Reached::surface || walk.index > e.max_bounces) return;

        const PathVertex& v = walk.vertex;
        if (v.connectible) {
            if (e.families.next_event && record.wants({v.index + 1, 1}))
                record_own(e, connect_to_light<F>(e, v, walk.numbers.connect, rays), record);
            if constexpr (!F.path_tracer)
                for (const PathVertex& l : light) {
                    if (v.index + l.index > e.max_bounces) break;
                    if (record.wants({v.index + 1, l.index + 1}))
                        record_own(e, connect<F>(e, v, l, rays), record);
                }
        }
        if (has_found_all(e, walk.index) || !scatter(walk)) return;
    }
}

// The sample of one pixel in one pass, with the light subpaths that belong to it.
template <Facts F = no_facts, class Record>
void estimate(const Estimator& e, int x, int y, std::uint64_t pass, LightSubpath& scratch,
              Record& record, RayCounts& rays) {
    scratch.clear();
    if constexpr (F.path_tracer) {
        trace_camera_subpath<F>(e, x, y, pass, scratch, record, rays);
    } else {
        if (!e.families.needs_light_subpaths())
            return trace_camera_subpath<F>(e, x, y, pass, scratch, record, rays);
        const auto area = static_cast<std::uint64_t>(e.crop.area());
        const std::uint64_t first = paired_subpath(e, x, y, pass);
        if (first < e.light_subpaths) trace_light_subpath<F>(e, first, pass, scratch, record, rays);
        trace_camera_subpath<F>(e, x, y, pass, scratch, record, rays);
        for (std::uint64_t more = first + area; more < e.light_subpaths; more += area)
            trace_light_subpath<F>(e, more, pass, scratch, record, rays);
    }
}

}  // namespace midway
