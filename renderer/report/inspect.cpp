#include "report/inspect.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/float_mode.h"
#include "report/whole_path_recursion.h"

namespace midway {
namespace {

struct Inspection {
    const Estimator& e;
    const Scene& scene;
    Recording recording;
    PathSetting setting;
    double scale = 1;  // of lengths, from the file's units to the scene's

    dvec3 in_file(const vec3& p) const {
        const Normalisation& n = scene.geometry->normalisation;
        return dvec3(p) / n.scale + n.center;
    }
    Density per_area(double pdf) const { return {pdf * sqr(scale), Measure::per_area}; }
};

VertexKind kind_of(LightKind k) {
    switch (k) {
        case LightKind::point:
            return VertexKind::point_light;
        case LightKind::spot:
            return VertexKind::spot_light;
        case LightKind::directional:
            return VertexKind::sun;
        case LightKind::area:
            return VertexKind::area_light;
        case LightKind::sky:
            return VertexKind::sky;
    }
    return VertexKind::nothing;
}

void name_object(const Inspection& in, int object, InspectedVertex& v) {
    v.object = object;
    const Object& o = in.scene.geometry->objects[object];
    v.object_name = o.name;
    v.material_name = in.scene.materials[o.material].name;
}

InspectedVertex surface_vertex(const Inspection& in, const PathVertex& p, int object) {
    InspectedVertex v;
    v.position = in.in_file(p.position);
    v.normal = p.ng;
    v.connectible = p.connectible;
    v.black = p.bsdf.empty();
    v.shines = in.scene.first_light[object] >= 0;
    v.roughness = p.bsdf.only_diffuse ? 1 : std::sqrt(p.bsdf.alpha);
    v.throughput = p.throughput;
    name_object(in, object, v);
    return v;
}

// `place` is a position of the scene, or a direction towards the light where that is infinite.
InspectedVertex light_vertex(const Inspection& in, int id, const vec3& place) {
    const Light& l = in.scene.lights[id];
    InspectedVertex v;
    v.kind = kind_of(l.kind);
    v.infinite = is_infinite(l.kind);
    v.position = v.infinite ? dvec3(place) : in.in_file(place);
    if (l.kind != LightKind::area) return v;
    v.normal = triangle_shape(in.scene.geometry->objects[l.object], l.triangle).normal;
    name_object(in, l.object, v);
    return v;
}

// The density of a point of a light where its measure depends on the light's kind.
Density at_light(const Inspection& in, VertexKind kind, double pdf) {
    if (kind == VertexKind::area_light) return in.per_area(pdf);
    if (kind == VertexKind::sky) return {pdf, Measure::per_solid_angle};
    return {pdf, Measure::probability};
}

Density of_direction(float pdf, bool delta) {
    return {pdf, delta ? Measure::probability : Measure::per_solid_angle};
}

// The geometric factor of eq. (3) at vertex `at` of a walk, seen from vertex `from`.
double g_at(const RecordedWalk& w, int at, int from) {
    if (from == 0 && w.start.infinite_light)
        return abs_dot(w.vertices[at].ng, w.start.ray.direction);
    const vec3 a = w.vertices[at].position;
    const vec3 b = from == 0 ? w.start.previous_position : w.vertices[from].position;
    const vec3 d = b - a;
    const double distance2 = length_squared(d);
    return abs_dot(w.vertices[at].ng, d) / std::sqrt(distance2) / distance2;
}

// Surfaces 1 .. count of a walk, with all densities that the walk knows.
void add_surfaces(const Inspection& in, const RecordedWalk& w, int count,
                  std::vector<InspectedVertex>& to) {
    const int scattered = static_cast<int>(w.scattered.size()) - 1;
    for (int i = 1; i <= count; ++i) {
        InspectedVertex v = surface_vertex(in, w.vertices[i], w.hits[i].object);
        const bool from_light = w.start.transport == Transport::importance;
        const double made = i > 1        ? w.scattered[i - 1].fwd
                            : from_light ? w.start.light_pdfs.leave
                                         : w.start.pdf_fwd_w;
        v.fwd = in.per_area(made * g_at(w, i, i - 1));
        if (i < count && i < scattered)
            v.rev = in.per_area(w.scattered[i + 1].rev * g_at(w, i, i + 1));
        if (i <= scattered && (i < count || w.escaped)) {
            const Scattering& s = w.scattered[i];
            v.delta = s.delta;
            v.scatter_fwd = of_direction(s.fwd, s.delta);
            v.scatter_rev = of_direction(s.rev, s.delta);
        }
        to.push_back(v);
    }
}

// Where the last ray of a walk left the scene.
InspectedVertex escape(const Inspection& in, const RecordedWalk& w) {
    InspectedVertex v;
    v.kind = w.start.transport == Transport::radiance && in.scene.sky_light >= 0
                 ? VertexKind::sky
                 : VertexKind::nothing;
    v.infinite = true;
    v.position = dvec3(w.now.ray.direction);
    v.throughput = w.now.throughput;
    const bool delta = w.now.index > 1 && w.now.delta;
    v.fwd = of_direction(w.now.pdf_fwd_w, delta);
    return v;
}

std::vector<InspectedVertex> camera_subpath(const Inspection& in, const RecordedWalk& w) {
    std::vector<InspectedVertex> list(1);
    InspectedVertex& lens = list.front();
    lens.kind = VertexKind::camera;
    lens.position = in.in_file(w.start.ray.origin);
    lens.throughput = vec3(1);
    lens.scatter_fwd = {w.start.pdf_fwd_w, Measure::per_solid_angle};
    // Families that are not in use would have walked on.
    int count = static_cast<int>(w.vertices.size()) - 1;
    bool whole = true;
    for (int i = 1; i <= count && whole; ++i)
        if (has_found_all(in.e, i)) {
            whole = i == count && !w.escaped;
            count = i;
        }
    add_surfaces(in, w, count, list);
    if (whole && w.escaped) list.push_back(escape(in, w));
    return list;
}

std::vector<InspectedVertex> light_subpath(const Inspection& in, const RecordedWalk& w) {
    const Walk& start = w.start;
    const bool sun = is_infinite(in.scene.lights[start.light].kind);
    InspectedVertex light =
        light_vertex(in, start.light, sun ? -start.ray.direction : start.previous_position);
    light.throughput = start.throughput / static_cast<float>(sqr(in.scale));
    light.fwd = at_light(in, light.kind, start.light_pdfs.origin);
    light.scatter_fwd = sun ? in.per_area(start.light_pdfs.leave)
                            : Density{start.light_pdfs.leave, Measure::per_solid_angle};
    if (w.scattered.size() > 1 && start.hittable_light) {
        const vec3 d = start.previous_position - w.vertices[1].position;
        const double g = sun ? 1 : start.cos_previous / length_squared(d);
        light.rev = at_light(in, light.kind, w.scattered[1].rev * g);
    }
    std::vector<InspectedVertex> list{light};
    add_surfaces(in, w, static_cast<int>(w.vertices.size()) - 1, list);
    for (size_t i = 1; i < list.size(); ++i)
        list[i].throughput /= static_cast<float>(sqr(in.scale));
    if (!w.escaped) return list;
    InspectedVertex end = escape(in, w);
    end.throughput /= static_cast<float>(sqr(in.scale));
    if (w.now.index == 1) end.fwd = light.scatter_fwd;
    list.push_back(end);
    return list;
}

// `met`: by path, whose light subpath it meets, as DrawnPath::met.
void add_neighbours(const Inspection& in, const DrawnSample& drawn, const std::vector<int>& met,
                    InspectedSample& s) {
    const PixelGroup group = group_of(in.e.crop, s.x, s.y);
    for (int place = 0; place < static_cast<int>(drawn.lights.size()); ++place) {
        if (place == drawn.place || std::ranges::find(met, place) == met.end()) continue;
        for (size_t i = 0; i < met.size(); ++i)
            if (met[i] == place) s.paths[i].neighbour = s.neighbours.size();
        s.neighbours.push_back({group.x(place), s.y,
                                paired_subpath(in.e, group.x(place), s.y, s.pass),
                                light_subpath(in, *drawn.lights[static_cast<size_t>(place)])});
    }
}

// A lamp or the sky seen directly: emitter hits alone show it.
std::vector<InspectedStrategy> direct_strategy(const Inspection& in, const DrawnPath& p) {
    InspectedStrategy s;
    s.strategy = p.contribution.strategy;
    s.feasible = true;
    const double area = p.infinite ? 1 : sqr(in.scale);
    s.log10_pdf = std::log10(p.pdfs.from_camera(1) * area);
    s.weights.assign(p.contribution.weights.begin(),
                     p.contribution.weights.begin() + in.e.exponent_count);
    s.direct.assign(s.weights.size(), 1);
    s.value = p.contribution.value;
    return {s};
}

// Every strategy of a path with at least two edges.
std::vector<InspectedStrategy> all_strategies(const Inspection& in, const DrawnPath& p) {
    const int k = p.edges();
    const std::vector<long double> logs = log_densities(p.pdfs, in.setting);
    const size_t found = static_cast<size_t>(p.contribution.strategy.s) - 1;
    const bool on_surface = in.scene.lights[p.light_id].kind == LightKind::area;
    const double areas = k - 1 + (on_surface ? 1 : 0);
    std::vector<InspectedStrategy> list(logs.size());
    for (size_t i = 0; i < list.size(); ++i) {
        InspectedStrategy& s = list[i];
        s.strategy = {static_cast<int>(i) + 1, k - static_cast<int>(i)};
        s.feasible = is_feasible(p.pdfs, s.strategy, in.setting);
        s.log10_pdf =
            static_cast<double>(logs[i] / std::log(10.0L)) + 2 * areas * std::log10(in.scale);
        if (s.feasible && std::isfinite(logs[i]))
            s.value = p.contribution.value * static_cast<float>(std::exp(logs[found] - logs[i]));
    }
    for (int b = 0; b < in.e.exponent_count; ++b) {
        const std::vector<double> direct = direct_weights(logs, in.e.exponents[b]);
        std::vector<double> recursive =
            recursive_weights(p.pdfs, p.pdfs, in.setting, in.e.exponents[b]);
        recursive[found] = p.contribution.weights[b];
        for (size_t i = 0; i < list.size(); ++i) {
            list[i].weights.push_back(recursive[i]);
            list[i].direct.push_back(direct[i]);
        }
    }
    return list;
}

std::vector<dvec3> points_of(const Inspection& in, const DrawnPath& p) {
    std::vector<dvec3> points{in.in_file(p.lens)};
    for (int i = 1; i < p.edges(); ++i) points.push_back(in.in_file(p.surfaces[i].position));
    points.push_back(p.infinite ? dvec3(p.light) : in.in_file(p.light));
    return points;
}

InspectedPath inspect_path(const Inspection& in, const DrawnPath& p, int unit_exponent) {
    InspectedPath path;
    path.contribution = p.contribution;
    path.splat = family_of(p.contribution.strategy) == Family::light_tracing;
    path.x = p.x;
    path.y = p.y;
    const auto exponents = static_cast<size_t>(in.e.exponent_count);
    path.usable = is_usable(p.contribution, exponents);
    path.recorded.resize(exponents);
    path.fixed.resize(exponents);
    for (size_t i = 0; i < exponents && path.usable; ++i) {
        const RecordedValue v = recorded_value(in.recording, p.contribution, i);
        FixedCounts ignored;
        path.recorded[i] = v.value;
        for (int k = 0; k < 3; ++k)
            path.fixed[i][k] = recorded_fixed(p.contribution, v, k, unit_exponent, ignored);
        if (i == 0) path.clamped = v.clamped;
    }
    path.strategies = p.edges() == 1 ? direct_strategy(in, p) : all_strategies(in, p);
    path.points = points_of(in, p);
    path.infinite = p.infinite;
    path.light_end = light_vertex(in, p.light_id, p.light);
    return path;
}

// Whether the render forms this path at all, and its films take it.
bool is_recorded(const Estimator& e, const Recording& recording, const Strategy& k) {
    const bool formed = e.forms(k) || (k == Strategy{2, 0} && e.direct_lamps);
    return formed && recording.wants(k);
}

}  // namespace

const char* to_string(VertexKind kind) {
    switch (kind) {
        case VertexKind::camera:
            return "camera";
        case VertexKind::surface:
            return "surface";
        case VertexKind::point_light:
            return "point light";
        case VertexKind::spot_light:
            return "spot light";
        case VertexKind::sun:
            return "sun";
        case VertexKind::area_light:
            return "area light";
        case VertexKind::sky:
            return "sky";
        case VertexKind::nothing:
            return "left the scene";
    }
    return "";
}

InspectedSample inspect_sample(const Inspectable& what, int x, int y, std::uint64_t pass) {
    const ScopedFlushToZero flush;
    const Scene& scene = *what.scene;
    const Estimator e = make_estimator(scene, what.camera, what.settings);
    const Inspection in{e, scene, make_recording(what.settings), path_setting(e),
                        scene.geometry->normalisation.scale};
    InspectedSample s;
    s.x = x;
    s.y = y;
    s.pass = pass;
    const std::uint64_t paired = paired_subpath(e, x, y, pass);
    if (e.families.needs_light_subpaths() && paired < e.light_subpaths) s.light_subpath = paired;
    s.exponents = what.settings.exponents;
    s.unit_exponent = film_unit_exponent(scene.total_power);
    std::vector<int> met;
    const DrawnSample drawn = draw_paths(e, x, y, pass, [&](const DrawnPath& p) {
        if (!is_recorded(e, in.recording, p.contribution.strategy)) return;
        s.paths.push_back(inspect_path(in, p, s.unit_exponent));
        met.push_back(p.met);
    });
    s.camera = camera_subpath(in, drawn.camera);
    if (drawn.light()) s.light = light_subpath(in, *drawn.light());
    add_neighbours(in, drawn, met, s);
    return s;
}

const std::vector<InspectedVertex>& light_subpath_of(const InspectedSample& sample,
                                                     const InspectedPath* path) {
    if (!path || !path->neighbour) return sample.light;
    return sample.neighbours[*path->neighbour].vertices;
}

std::vector<vec3> recorded_in(const InspectedSample& s, int x, int y) {
    std::vector<vec3> sums(s.exponents.size(), vec3(0));
    for (const InspectedPath& p : s.paths)
        if (p.x == x && p.y == y)
            for (size_t i = 0; i < sums.size(); ++i) sums[i] += p.recorded[i];
    return sums;
}

}  // namespace midway
