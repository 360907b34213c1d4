#include "report/drawn_path.h"

#include <algorithm>
#include <cmath>

namespace midway {
namespace {

// What the strategy says about the light's end of a path.
struct LightEnd {
    vec3 position{0};  // or the direction towards an infinite light
    bool infinite = false, hittable = true;
    double cosine = 1;
    LightPdfs pdfs;
    int id = -1;
};

vec3 direction(const vec3& from, const vec3& to) {
    const vec3 d = to - from;
    return d / static_cast<float>(std::sqrt(length_squared(d)));
}

vec3 towards(const DrawnPath& p, int i, int neighbour) {
    const vec3& from = p.surfaces[i].position;
    if (neighbour == 0) return direction(from, p.lens);
    if (neighbour == p.edges()) return p.infinite ? p.light : direction(from, p.light);
    return direction(from, p.surfaces[neighbour].position);
}

vec3 place(const DrawnPath& p, int i) {
    return i == 0 ? p.lens : i == p.edges() ? p.light : p.surfaces[i].position;
}

// Joins camera vertices 1 .. from_camera and light vertices 1 .. from_light, with all g and the
// pdfs at the light; the pdfs of scattering are left to the caller.
DrawnPath join(const RecordedWalk& camera, int from_camera, const RecordedWalk* light,
               int from_light, const LightEnd& end, const vec3& lens) {
    DrawnPath p;
    const int k = from_camera + from_light + 1;
    p.pdfs.vertices.resize(k + 1);
    p.surfaces.resize(k);
    p.lens = lens;
    p.light = end.position;
    p.infinite = end.infinite;
    p.light_id = end.id;
    for (int i = 1; i <= from_camera; ++i) p.surfaces[i] = camera.vertices[i];
    for (int j = 1; j <= from_light; ++j) p.surfaces[k - j] = light->vertices[j];
    for (int i = 1; i < k; ++i) {
        VertexPdfs& v = p.pdfs.vertices[i];
        const vec3 ng = p.surfaces[i].ng;
        v.camera_g =
            abs_dot(ng, towards(p, i, i - 1)) / length_squared(place(p, i) - place(p, i - 1));
        v.light_g = abs_dot(ng, towards(p, i, i + 1));
        if (i + 1 < k || !p.infinite) v.light_g /= length_squared(place(p, i + 1) - place(p, i));
    }
    p.pdfs.vertices[k].camera_g =
        p.infinite ? 1 : end.cosine / length_squared(p.light - place(p, k - 1));
    p.pdfs.vertices[k - 1].light_w = end.pdfs.leave;
    p.pdfs.emission = end.pdfs.origin;
    p.pdfs.next_event = end.pdfs.next_event;
    p.pdfs.hittable = end.hittable;
    return p;
}

// Scattering of camera vertices 1 .. last, towards and away from the camera.
void add_camera_pdfs(DrawnPath& p, const RecordedWalk& camera, int last) {
    p.pdfs.vertices[1].camera_w = camera.start.pdf_fwd_w;
    for (int i = 1; i <= last; ++i) {
        const Scattering& s = camera.scattered[i];
        p.pdfs.vertices[i + 1].camera_w = s.fwd;
        p.pdfs.vertices[i - 1].light_w = s.rev;
        p.pdfs.vertices[i].delta = s.delta;
    }
}

void add_light_pdfs(DrawnPath& p, const RecordedWalk& light, int last) {
    for (int j = 1; j <= last; ++j) {
        const Scattering& s = light.scattered[j];
        const int i = p.edges() - j;
        p.pdfs.vertices[i - 1].light_w = s.fwd;
        p.pdfs.vertices[i + 1].camera_w = s.rev;
        p.pdfs.vertices[i].delta = s.delta;
    }
}

// The end of a strategy's camera subpath (or light subpath) where it is connected to a neighbour.
void add_camera_end(DrawnPath& p, int i) {
    const BsdfEval f = eval_bsdf(p.surfaces[i].bsdf, p.surfaces[i].to_previous,
                                 towards(p, i, i + 1), Transport::radiance);
    p.pdfs.vertices[i + 1].camera_w = f.pdf_fwd_w;
    p.pdfs.vertices[i - 1].light_w = f.pdf_rev_w;
}

void add_light_end(DrawnPath& p, int i) {
    const BsdfEval f = eval_bsdf(p.surfaces[i].bsdf, p.surfaces[i].to_previous,
                                 towards(p, i, i - 1), Transport::importance);
    p.pdfs.vertices[i - 1].light_w = f.pdf_fwd_w;
    p.pdfs.vertices[i + 1].camera_w = f.pdf_rev_w;
}

void add_vertex(RecordedWalk& w) {
    w.vertices.push_back(w.now.vertex);
    w.hits.push_back(w.now.point->hit);
}

// scatter() of the last vertex, with its pdfs put on record.
bool scatter_on_record(RecordedWalk& w) {
    if (!scatter(w.now)) return false;
    w.scattered.push_back({w.now.pdf_fwd_w, w.now.pdf_rev_w, w.now.delta});
    return true;
}

int light_of(const Scene& scene, const TriangleHit& hit) {
    return scene.first_light[hit.object] + hit.triangle;
}

using Visit = std::function<void(DrawnPath&)>;

LightEnd end_of(const RecordedWalk& light) {
    const Walk& start = light.start;
    return {start.infinite_light ? -start.ray.direction : start.previous_position,
            start.infinite_light,
            start.hittable_light,
            start.cos_previous,
            light.now.light_pdfs,  // next event's are known from the first vertex on
            start.light};
}

void visit_light_tracing(const Estimator& e, const RecordedWalk& light, const Visit& visit) {
    const PathVertex& v = light.now.vertex;
    const vec4& u = light.now.numbers.connect;
    RayCounts rays;
    const std::optional<Splat> s = connect_to_camera(e, v, u, rays);
    if (!s) return;
    const vec3 lens = lens_point(e.camera, {u.x, u.y});
    DrawnPath p = join({}, 0, &light, v.index, end_of(light), lens);
    p.contribution = s->contribution;
    p.x = s->x;
    p.y = s->y;
    add_light_pdfs(p, light, v.index - 1);
    add_light_end(p, 1);
    p.pdfs.vertices[1].camera_w =
        camera_pdf_w(e.camera, -glm::dot(towards(p, 1, 0), e.camera.forward));
    visit(p);
}

void visit_hit(const Estimator& e, const RecordedWalk& camera, Reached reached,
               const Visit& visit) {
    const Walk& w = camera.now;
    const std::optional<Contribution> c = hit_light(e, w, reached);
    if (!c) return;
    LightEnd end;
    end.infinite = reached == Reached::sky;
    end.position = end.infinite ? w.ray.direction : w.vertex.position;
    end.cosine = end.infinite ? 1 : abs_dot(w.vertex.ng, w.vertex.to_previous);
    end.pdfs =
        (end.infinite ? sky_hit(*e.scene, w.ray.direction)
                      : emitter_hit(*e.scene, *w.point, w.vertex.to_previous, w.previous_position))
            ->pdfs;
    end.id = end.infinite ? e.scene->sky_light : light_of(*e.scene, w.point->hit);
    DrawnPath p = join(camera, w.index - 1, nullptr, 0, end, camera.start.ray.origin);
    p.contribution = *c;
    add_camera_pdfs(p, camera, w.index - 1);
    p.pdfs.vertices[w.index - 1].light_w = end.pdfs.leave;
    visit(p);
}

void visit_next_event(const Estimator& e, const RecordedWalk& camera, const vec4& u,
                      const Visit& visit) {
    const PathVertex& v = camera.now.vertex;
    RayCounts rays;
    const std::optional<Contribution> c = connect_to_light(e, v, u, rays);
    if (!c) return;
    const NextEventSample n = *sample_next_event(*e.scene, v.position, next_event_numbers(u));
    const LightKind kind = e.scene->lights[n.light].kind;
    const LightEnd end{is_infinite(kind) ? n.direction : n.target,
                       is_infinite(kind),
                       !is_delta(kind),
                       n.cos_theta,
                       n.pdfs,
                       n.light};
    DrawnPath p = join(camera, v.index, nullptr, 0, end, camera.start.ray.origin);
    p.contribution = *c;
    add_camera_pdfs(p, camera, v.index - 1);
    add_camera_end(p, v.index);
    p.pdfs.vertices[v.index].light_w = end.pdfs.leave;
    visit(p);
}

// Vertex j of the light subpath at a place of the group; null where nothing can be connected to.
const PathVertex* light_vertex(const DrawnSample& sample, int from, int j) {
    const std::optional<RecordedWalk>& light = sample.lights[static_cast<size_t>(from)];
    if (!light || static_cast<size_t>(j) >= light->vertices.size()) return nullptr;
    const PathVertex& l = light->vertices[static_cast<size_t>(j)];
    return l.connectible ? &l : nullptr;
}

void visit_connection(const Estimator& e, const DrawnSample& sample, const ConnectionChoice& choice,
                      const Visit& visit) {
    const RecordedWalk& camera = sample.camera;
    const PathVertex& v = camera.now.vertex;
    RayCounts rays;
    const std::optional<Contribution> c = connect(e, v, choice, rays);
    if (!c) return;
    const RecordedWalk& light = *sample.lights[static_cast<size_t>(choice.place)];
    const PathVertex& l = *choice.light;
    DrawnPath p = join(camera, v.index, &light, l.index, end_of(light), camera.start.ray.origin);
    p.contribution = *c;
    add_camera_pdfs(p, camera, v.index - 1);
    add_light_pdfs(p, light, l.index - 1);
    add_camera_end(p, v.index);
    add_light_end(p, v.index + 1);
    p.met = choice.place;
    visit(p);
}

void visit_connections(const Estimator& e, const DrawnSample& sample, const Visit& visit) {
    const Walk& camera = sample.camera.now;
    const int group = static_cast<int>(sample.lights.size());
    if (group == 0) return;
    const auto vertex = [&](int from, int j) { return light_vertex(sample, from, j); };
    size_t longest = 0;
    for (const std::optional<RecordedWalk>& l : sample.lights)
        if (l) longest = std::max(longest, l->vertices.size() - 1);
    const int last = std::min(static_cast<int>(longest), e.max_bounces - camera.index);
    for_each_choice(camera.vertex.rough == 0, last, [&](int j, int end) {
        const ConnectionChoice choice =
            choose_connection(e, camera, sample.place, group, j, end, vertex);
        if (choice.light) visit_connection(e, sample, choice, visit);
    });
}

// Without `visit` nothing is splatted.
std::optional<RecordedWalk> record_light(const Estimator& e, std::uint64_t subpath,
                                         std::uint64_t pass, const Visit& visit) {
    const std::optional<Walk> start = start_light_walk(e, subpath, pass);
    if (!start) return {};
    RecordedWalk w;
    w.start = w.now = *start;
    while (w.now.index < e.max_bounces) {
        const Reached reached = extend(e, w.now);
        w.escaped = reached == Reached::sky;
        if (reached != Reached::surface) break;
        add_vertex(w);
        // Where light tracing has no samples its weight would be a division by zero.
        if (visit && w.now.vertex.connectible && e.share_of(w.now.index + 1) > 0)
            visit_light_tracing(e, w, visit);
        if (!scatter_on_record(w)) break;
    }
    return w;
}

// The coefficient of a delta lobe that leads from one direction to another: that of the sample
// which comes closest.
Scattering delta_pdfs(const Bsdf& bsdf, const vec3& from, const vec3& to, Transport transport) {
    Scattering best;
    float closest = 0.999f;
    for (int i = 0; i <= 64; ++i) {
        // Both ends are tried: a lobe may have next to no probability.
        const float u = std::clamp(i / 64.0f, 1e-7f, 1 - 0x1p-24f);
        const auto s = sample_bsdf(bsdf, from, {0.5f, 0.5f, u}, transport);
        if (!s || !s->delta || !(glm::dot(s->to, to) > closest)) continue;
        closest = glm::dot(s->to, to);
        best = {s->pdf_fwd_w, s->pdf_rev_w, true};
    }
    return best;
}

// The light's densities as the camera's walk finds them that hits it.
void hit_again(const Estimator& e, const DrawnPath& path, PathPdfs& own) {
    const int k = path.edges();
    std::optional<EmitterHit> hit;
    if (path.infinite) {
        hit = sky_hit(*e.scene, path.light);
    } else {
        const PathVertex& v = path.surfaces[k - 1];
        const vec3 d = towards(path, k - 1, k);
        const Ray ray{offset_origin(v.position, v.ng, v.error, d), d};
        const std::optional<SurfacePoint> p = intersect(*e.scene, ray, 0);
        // A leaf in between is another story.
        if (p && length_squared(p->position - path.light) < 1e-8f)
            hit = emitter_hit(*e.scene, *p, -d, v.position);
    }
    if (!hit) return;
    own.emission = hit->pdfs.origin;
    own.next_event = hit->pdfs.next_event;
    own.vertices[k - 1].light_w = hit->pdfs.leave;
}

}  // namespace

DrawnSample draw_paths(const Estimator& e, int x, int y, std::uint64_t pass, const Visit& found) {
    const PixelGroup g = group_of(e.crop, x, y);
    DrawnSample sample;
    sample.place = g.place_of(x);
    sample.lights.resize(static_cast<size_t>(g.size()));
    // Of each camera sample's light subpaths the first is met; further ones are splatted alone.
    for (int place = 0; place < g.size() && e.families.needs_light_subpaths(); ++place) {
        const bool own = place == sample.place;
        const std::uint64_t paired = paired_subpath(e, g.x(place), y, pass);
        for_each_subpath(e, paired, [&](std::uint64_t subpath) {
            if (!own && subpath != paired) return;
            auto light = record_light(e, subpath, pass, own ? found : Visit{});
            if (subpath == paired) sample.lights[static_cast<size_t>(place)] = std::move(light);
        });
    }
    // What the camera's walk finds belongs to its own pixel.
    const Visit visit = [&](DrawnPath& p) {
        p.x = x;
        p.y = y;
        found(p);
    };
    RecordedWalk& camera = sample.camera;
    camera.start = camera.now = start_camera_walk(e, x, y, pass);
    for (;;) {
        const Reached reached = extend(e, camera.now);
        camera.escaped = reached == Reached::sky;
        if (reached != Reached::nothing) visit_hit(e, camera, reached, visit);
        if (reached == Reached::surface) add_vertex(camera);
        if (reached != Reached::surface || camera.now.index > e.max_bounces) return sample;
        if (camera.now.vertex.connectible) {
            for_each_next_event(e, camera.now.index, camera.now.numbers.connect,
                                [&](const vec4& u, int) { visit_next_event(e, camera, u, visit); });
            visit_connections(e, sample, visit);
        }
        if (!scatter_on_record(camera)) return sample;
    }
}

OwnPdfs own_pdfs(const Estimator& e, const DrawnPath& path, Transport side) {
    OwnPdfs own{path.pdfs, std::vector<bool>(path.edges() + 1, true)};
    std::vector<VertexPdfs>& v = own.pdfs.vertices;
    const bool from_camera = side == Transport::radiance;
    for (int i = 1; i < path.edges(); ++i) {
        const vec3 back = towards(path, i, i - 1), ahead = towards(path, i, i + 1);
        const vec3 &from = from_camera ? back : ahead, &to = from_camera ? ahead : back;
        Scattering s;
        if (v[i].delta) {
            s = delta_pdfs(path.surfaces[i].bsdf, from, to, side);
        } else {
            const BsdfEval f = eval_bsdf(path.surfaces[i].bsdf, from, to, side);
            s = {f.pdf_fwd_w, f.pdf_rev_w, false};
            own.scatters[i] = !is_black(f.f);
        }
        v[i + 1].camera_w = from_camera ? s.fwd : s.rev;
        v[i - 1].light_w = from_camera ? s.rev : s.fwd;
    }
    const int k = path.edges();
    v[1].camera_w = camera_pdf_w(e.camera, -glm::dot(towards(path, 1, 0), e.camera.forward));
    v[k - 1].light_w = path.pdfs.vertices[k - 1].light_w;
    if (from_camera && own.pdfs.hittable) hit_again(e, path, own.pdfs);
    return own;
}

}  // namespace midway
