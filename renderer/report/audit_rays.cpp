#include "report/audit_rays.h"

#include <cmath>

#include "integrator/edge.h"
#include "math/hash.h"
#include "math/warp.h"
#include "report/audit_leaks.h"
#include "report/audit_rows.h"

namespace midway {
namespace {

constexpr size_t most_closed_meshes = 1000;
constexpr int random_rays = 2;  // per side and hit, beside the one back along the edge

// Walks take coins and groups of the sampler of their own; these numbers come from a hash.
struct Numbers {
    std::uint64_t state;
    float next() {
        state = mix64(state);
        return to_unit_float(static_cast<std::uint32_t>(state >> 32));
    }
};

struct Tracer {
    const Estimator& e;
    const std::vector<std::unique_ptr<ClosedMesh>>& closed;
    RayAudit& sums;
    AuditPlace place;

    const std::string& name(int object) const { return e.scene->geometry->objects[object].name; }

    void leave(const Walk& w, const vec3& direction) {
        const PathVertex& v = w.vertex;
        const TriangleHit& own = w.point->hit;
        const LeavingRay leaving{{offset_origin(v.position, v.ng, v.error, direction), direction},
                                 v.position,
                                 v.error,
                                 own.triangle,
                                 glm::dot(v.ng, direction) > 0};
        ++sums.rays;
        const TriangleHit hit = e.scene->accel->closest(leaving.ray, {e.scene}, 0);
        if (hit.object == own.object && hit.triangle == own.triangle)
            sums.self_hits.add(place, name(own.object));
        const ClosedMesh* mesh = closed[own.object].get();
        if (!mesh) return;
        ++sums.closed_rays;
        const LeakFinding finding = follow(*mesh, leaving);
        if (finding.outcome == RayOutcome::leak) {
            sums.leaks.add(place, name(own.object));
            sums.farthest_leak = std::max(sums.farthest_leak, finding.edge_distance);
        }
        if (finding.outcome == RayOutcome::unexplained)
            sums.unexplained.add(place, name(own.object));
        if (finding.outcome == RayOutcome::overlap) ++sums.overlaps;
    }

    // Every second direction is grazing, its cosine spread over six decades.
    void leave_at_random(const Walk& w, Numbers& numbers) {
        const Frame frame = frame_from_normal(w.vertex.ng);
        for (int i = 0; i < 2 * random_rays; ++i) {
            const float u = numbers.next(), phi = 2 * pi * numbers.next();
            const float cosine = i & 2 ? std::pow(10.0f, -6 * u) : u;
            const float sine = safe_sqrt(1 - sqr(cosine));
            const vec3 local(sine * std::cos(phi), sine * std::sin(phi), i & 1 ? -cosine : cosine);
            const vec3 direction = frame.to_world(local);
            if (glm::dot(w.vertex.ng, direction) != 0) leave(w, direction);
        }
    }

    // Would a connection see what the walk saw? To the camera it is traced from the surface, to a
    // surface from the one before.
    void try_edge(const Walk& w, const PathVertex* before, const vec3& lens) {
        const PathVertex& v = w.vertex;
        ++sums.edges;
        const float seen =
            before ? edge_visibility(*e.scene, *before, v) : edge_visibility(*e.scene, v, lens);
        if (seen == 0) sums.blocked.add(place, name(w.point->hit.object));
    }

    void walk(Walk w, bool camera, Numbers& numbers, std::vector<PathVertex>& vertices) {
        place.strategy = camera ? Strategy{1, 0} : Strategy{0, 1};
        const vec3 start = w.previous_position;
        while (w.index < e.max_bounces) {
            const Reached reached = extend(e, w);
            place.vertex = w.index;
            if (reached == Reached::nothing) ++sums.stopped;
            if (reached != Reached::surface) return;
            // Light subpaths' first edges are next event's business.
            if (camera || !vertices.empty())
                try_edge(w, vertices.empty() ? nullptr : &vertices.back(), start);
            leave(w, w.vertex.to_previous);
            leave_at_random(w, numbers);
            vertices.push_back(w.vertex);
            if (!scatter(w)) return;
        }
    }

    void try_pair(const PathVertex& a, const PathVertex& b) {
        if (!(length_squared(b.position - a.position) > 0)) return;
        ++sums.pairs;
        place.vertex = a.index;
        const bool there = edge_visibility(*e.scene, a, b) > 0;
        const bool back = edge_visibility(*e.scene, b, a) > 0;
        if (there != back) sums.unequal.add(place, "");
    }
};

void add_sample(const Estimator& e, const std::vector<std::unique_ptr<ClosedMesh>>& closed, int x,
                int y, std::uint64_t pass, RayAudit& sums) {
    Tracer t{e, closed, sums, {x, y, pass, {}, -1}};
    const std::uint64_t pixel = (std::uint64_t(std::uint32_t(y)) << 32) | std::uint32_t(x);
    Numbers numbers{hash_combine(hash_combine(e.seed, pixel), pass)};
    std::vector<PathVertex> camera, light;
    t.walk(start_camera_walk(e, x, y, pass), true, numbers, camera);
    if (const auto w = start_light_walk(e, paired_subpath(e, x, y, pass), pass))
        t.walk(*w, false, numbers, light);
    if (camera.empty() || light.empty()) return;
    t.place.strategy = {2, 2};
    const auto pick = [&](const std::vector<PathVertex>& v) {
        return v[static_cast<size_t>(numbers.next() * static_cast<float>(v.size()))];
    };
    t.try_pair(pick(camera), pick(light));
}

}  // namespace

void RayFault::add(const AuditPlace& at, const std::string& name) {
    if (count++ == 0 || at.key() < place.key()) {
        place = at;
        object = name;
    }
}

void RayFault::merge(const RayFault& o) {
    if (o.count == 0) return;
    if (count == 0 || o.place.key() < place.key()) {
        place = o.place;
        object = o.object;
    }
    count += o.count;
}

void RayAudit::merge(const RayAudit& o) {
    rays += o.rays;
    closed_rays += o.closed_rays;
    overlaps += o.overlaps;
    edges += o.edges;
    pairs += o.pairs;
    stopped += o.stopped;
    self_hits.merge(o.self_hits);
    leaks.merge(o.leaks);
    unexplained.merge(o.unexplained);
    blocked.merge(o.blocked);
    unequal.merge(o.unequal);
    farthest_leak = std::max(farthest_leak, o.farthest_leak);
}

RayAudit audit_rays(const Estimator& e, const RayAuditOptions& options) {
    RayAudit all;
    if (options.rays <= 0) return all;
    const auto closed = closed_meshes(*e.scene, most_closed_meshes);
    const auto draw = [&](const AuditPasses& passes, const std::function<void(double)>& tick) {
        std::vector<RayAudit> sums(worker_count(options.threads));
        for_each_sample(
            e.crop, passes, sums,
            [&](RayAudit& s, int x, int y, std::uint64_t pass) {
                add_sample(e, closed, x, y, pass, s);
            },
            tick);
        for (const RayAudit& s : sums) all.merge(s);
    };
    draw({0, 1}, {});
    draw({1, passes_for(options.rays, all.rays)}, options.tick);
    return all;
}

}  // namespace midway
