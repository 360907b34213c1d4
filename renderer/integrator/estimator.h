// The estimators: `path`, `light` and `bdpt` of any exponent are one estimator with different
// families of strategies (README, "The method"). A sample is a camera subpath together with a light
// subpath for each of its connections (light_subpaths.h), and
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

#include "integrator/choice.h"
#include "integrator/light_subpaths.h"

namespace midway {

// What one strategy found for one path: its unweighted estimate of the pixel's value, and the MIS
// weight for every exponent.
struct Contribution {
    Strategy strategy;
    vec3 value{0};
    std::array<double, max_weights> weights;
    int sample = 0;          // of a vertex that asks for light more than once, which
    double probability = 1;  // of having been chosen among others, which the value makes up for
};

struct RayCounts {
    std::uint64_t closest = 0, shadow = 0, camera_paths = 0, light_paths = 0;
    // Shadow rays by strategy, where somebody asks (indexed by strategy_index; what has no place
    // of its own shares the last one).
    std::vector<std::uint64_t>* by_strategy = nullptr;

    void count_shadow(const Strategy& k, unsigned count = 1) {
        shadow += count;
        if (by_strategy)
            (*by_strategy)[std::min(strategy_index(k), by_strategy->size() - 1)] += count;
    }
};

// Next event from the camera vertex (t = 1); empty where nothing arrives.
template <Facts F = no_facts>
std::optional<Contribution> connect_to_light(const Estimator& e, const PathVertex& camera,
                                             const vec4& u, RayCounts& rays);

// Connections of a camera vertex (s, t >= 2), of which one is chosen to have its ray traced.
struct ConnectionChoice {
    Choice<double> among;
    Contribution contribution;  // of the chosen one
    const PathVertex* light = nullptr;
    int place = 0;  // of its light subpath in the group
};

// Offers the connection to a light vertex; `count`: of how many such the estimate is the mean.
template <Facts F = no_facts>
void offer_connection(const Estimator& e, const PathVertex& camera, const PathVertex& light,
                      int count, int place, ConnectionChoice& choice);

// Chooses one of the connections to light vertices j .. last; `vertex` gives that of a number on
// the light subpath at a place of the group, or null.
template <Facts F = no_facts, class Vertex>
ConnectionChoice choose_connection(const Estimator& e, const Walk& camera, int place, int group,
                                   int j, int last, const Vertex& vertex) {
    const PathVertex& v = camera.vertex;
    ConnectionChoice choice{.among = {choice_number(camera.key, v.index, j)}};
    const int count = v.rough == 0 ? group : 1;
    for (; j <= last; ++j)
        for_each_partner(v, place, j, group, [&](int from) {
            const PathVertex* l = vertex(from, j);
            if (l) offer_connection<F>(e, v, *l, count, from, choice);
        });
    return choice;
}

// The chosen connection, if its ray arrives.
std::optional<Contribution> connect(const Estimator& e, const PathVertex& camera,
                                    const ConnectionChoice& choice, RayCounts& rays);

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

// What a light contributes that strategy k has hit, for the sums of the last vertex, one for each
// exponent.
template <Facts F = no_facts>
Contribution weigh_hit(const Estimator& e, const EmitterHit& hit, const Strategy& k,
                       const vec3& throughput, const mis::State* sums);

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

// The light subpaths of one camera sample: splatted, and the one that it is paired with kept.
template <Facts F = no_facts, class Record>
void trace_light_subpaths(const Estimator& e, std::uint64_t paired, std::uint64_t pass, int place,
                          LightSubpaths& light, Record& record, RayCounts& rays) {
    LightSubpath* kept = &light.of[static_cast<size_t>(place)];
    for_each_subpath(e, paired, [&](std::uint64_t subpath) {
        trace_light_subpath<F>(e, subpath, pass, *kept, record, rays);
        if (!kept->empty()) light.longest = std::max(light.longest, kept->back().index);
        kept = &light.spare;
    });
}

// Every connection from a vertex of the camera sample at `place`.
template <Facts F = no_facts, class Record>
void connect_to_subpaths(const Estimator& e, const Walk& walk, const LightSubpaths& light,
                         int place, Record& record, RayCounts& rays) {
    const PathVertex& v = walk.vertex;
    const bool first = v.rough == 0;
    const auto vertex = [&](int from, int j) {
        return vertex_at(light.of[static_cast<size_t>(from)], j);
    };
    for_each_choice(first, std::min(light.longest, e.max_bounces - v.index), [&](int j, int last) {
        const ConnectionChoice choice =
            choose_connection<F>(e, walk, place, light.count, j, last, vertex);
        if (choice.light && record.wants(choice.contribution.strategy))
            record_own(e, connect(e, v, choice, rays), record);
    });
}

// Walks the camera subpath and forms every strategy that ends on it. `place`: of the sample in the
// group whose light subpaths are given.
template <Facts F = no_facts, class Record>
void trace_camera_subpath(const Estimator& e, int x, int y, std::uint64_t pass, int place,
                          const LightSubpaths& light, Record& record, RayCounts& rays) {
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
                for_each_next_event(e, v.index, walk.numbers.connect, [&](const vec4& u, int i) {
                    std::optional<Contribution> c = connect_to_light<F>(e, v, u, rays);
                    if (c) c->sample = i;
                    record_own(e, c, record);
                });
            if constexpr (!F.path_tracer)
                connect_to_subpaths<F>(e, walk, light, place, record, rays);
        }
        if (has_found_all(e, walk.index) || !scatter(walk)) return;
    }
}

// The camera samples of a group of pixels in one pass, with the light subpaths that belong to them.
// Record has, besides,
//   void begin(int x, int y, std::uint64_t pass)   what follows is of that pixel's sample
//   void end()                                     its own pixel has got all that it will get
// False: `go_on`, asked before every walk, said no.
template <Facts F = no_facts, class Record, class GoOn>
bool estimate(const Estimator& e, const PixelGroup& g, std::uint64_t pass, LightSubpaths& light,
              Record& record, RayCounts& rays, const GoOn& go_on) {
    const auto each = [&](const auto& trace) {
        for (int place = 0; place < g.size(); ++place) {
            if (!go_on()) return false;
            record.begin(g.x(place), g.y, pass);
            trace(place);
        }
        return true;
    };
    if constexpr (!F.path_tracer) {
        light.begin(g.size());
        if (e.families.needs_light_subpaths()) {
            const auto paired = paired_subpaths(e, g, pass);
            const bool done = each([&](int place) {
                trace_light_subpaths<F>(e, paired[static_cast<size_t>(place)], pass, place, light,
                                        record, rays);
            });
            if (!done) return false;
        }
    }
    return each([&](int place) {
        trace_camera_subpath<F>(e, g.x(place), g.y, pass, place, light, record, rays);
        e.at(Work::film);
        record.end();
        e.at(Work::other);
    });
}

// What a record may be that hears nothing.
struct DeafRecord {
    void contribution(const Contribution&) {}
    void splat(int, int, const Contribution&) {}
    bool wants(const Strategy& k) const { return family_of(k) != Family::light_tracing; }
};

// The sample of one pixel in one pass alone, with all that its group would give it.
template <class Record>
void estimate_alone(const Estimator& e, int x, int y, std::uint64_t pass, LightSubpaths& light,
                    Record& record, RayCounts& rays) {
    const PixelGroup g = group_of(e.crop, x, y);
    light.begin(g.size());
    DeafRecord deaf;
    RayCounts others;
    const auto paired = paired_subpaths(e, g, pass);
    for (int place = 0; place < g.size() && e.families.needs_light_subpaths(); ++place) {
        const std::uint64_t first = paired[static_cast<size_t>(place)];
        if (g.x(place) == x)
            trace_light_subpaths(e, first, pass, place, light, record, rays);
        else if (e.families.connection)
            trace_light_subpaths(e, first, pass, place, light, deaf, others);
    }
    trace_camera_subpath(e, x, y, pass, g.place_of(x), light, record, rays);
}

}  // namespace midway
