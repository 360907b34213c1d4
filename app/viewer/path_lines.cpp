#include "path_lines.h"

#include <algorithm>
#include <cmath>

namespace midway {
namespace {

// A ray to a point of a surface must end before it. Shares of the distance to the eye: of what
// lies nearer than this to a surface nobody sees on which side it is.
constexpr double ends_before = 2e-3, nearest_depth = 1e-4;
constexpr double pixels_per_look = 6;  // of a line, between rays
constexpr int fewest_looks = 4, most_looks = 96, halvings = 7;

// The last edge of a subpath or a path may lead to infinity.
dvec3 end_of(const dvec3& from, const dvec3& to, bool infinite, double far) {
    return infinite ? from + to * far : to;
}

void add_subpath(const std::vector<InspectedVertex>& vertices, LineKind kind, double far,
                 PathDrawing& drawing) {
    const std::string letter = kind == LineKind::camera ? "C" : "L";
    for (size_t i = 0; i < vertices.size(); ++i) {
        const InspectedVertex& v = vertices[i];
        if (!v.infinite) drawing.marks.push_back({v.position, letter + std::to_string(i), kind});
        if (i == 0) continue;
        const InspectedVertex& before = vertices[i - 1];
        if (before.infinite && v.infinite) continue;
        const dvec3 a =
            before.infinite ? end_of(v.position, before.position, true, far) : before.position;
        drawing.lines.push_back({a, end_of(a, v.position, v.infinite, far), kind});
    }
}

LineKind kind_of_edge(const Strategy& k, int edge) {
    if (edge < k.s) return LineKind::camera;
    // A camera that hits a light has walked all edges; every other strategy joins two ends.
    return edge == k.s ? LineKind::connection : LineKind::light;
}

void add_path(const InspectedPath& path, double far, PathDrawing& drawing) {
    const Strategy& k = path.contribution.strategy;
    for (int i = 1; i <= k.edges(); ++i) {
        const dvec3& a = path.points[static_cast<size_t>(i) - 1];
        const bool infinite = path.infinite && i == k.edges();
        const dvec3 b = end_of(a, path.points[static_cast<size_t>(i)], infinite, far);
        drawing.lines.push_back({a, b, kind_of_edge(k, i), true});
    }
    for (PathMark& m : drawing.marks)
        for (size_t i = 0; i + (path.infinite ? 1 : 0) < path.points.size(); ++i)
            m.picked |= m.at == path.points[i];
    // Next event chooses a point on a light that belongs to no subpath, light tracing one on the
    // lens.
    if (k.t == 1 && !path.infinite)
        drawing.marks.push_back({path.points.back(), "light", LineKind::light, true});
}

struct Eye {
    const Scene& scene;
    const Camera& camera;

    vec3 in_scene(const dvec3& p) const {
        const Normalisation& n = scene.geometry->normalisation;
        return vec3((p - n.center) * n.scale);
    }
    bool sees(const dvec3& point) const {
        const vec3 p = in_scene(point);
        const vec3 end = p + (camera.position - p) * static_cast<float>(ends_before);
        return visibility(scene, camera.position, end) > 0.5f;
    }
};

int looks_along(const Eye& eye, const PathLine& line) {
    const auto on_image =
        place_on_image(eye.camera, eye.scene.geometry->normalisation, line.a, line.b);
    if (!on_image) return 0;
    const double length = glm::length(on_image->b - on_image->a);
    return static_cast<int>(
        std::clamp(length / pixels_per_look, double(fewest_looks), double(most_looks)));
}

void cut(const Eye& eye, const PathLine& line, std::vector<PathLine>& pieces) {
    const int looks = looks_along(eye, line);
    if (looks == 0) return;
    const auto at = [&](double t) { return line.a + (line.b - line.a) * t; };
    const auto add = [&](double from, double to, bool seen) {
        PathLine piece = line;
        piece.a = at(from);
        piece.b = at(to);
        piece.hidden = !seen;
        pieces.push_back(piece);
    };
    double start = 0, before = 0;
    bool seen = eye.sees(at(0.5 / looks));
    for (int i = 0; i < looks; ++i) {
        const double t = (i + 0.5) / looks;
        if (eye.sees(at(t)) != seen) {
            double low = before, high = t;
            for (int k = 0; k < halvings; ++k) {
                const double middle = 0.5 * (low + high);
                (eye.sees(at(middle)) == seen ? low : high) = middle;
            }
            add(start, high, seen);
            start = high;
            seen = !seen;
        }
        before = t;
    }
    add(start, 1, seen);
}

}  // namespace

PathDrawing drawing_of(const InspectedSample& sample, int picked, double far) {
    PathDrawing drawing;
    add_subpath(sample.camera, LineKind::camera, far, drawing);
    const bool any = picked >= 0 && static_cast<size_t>(picked) < sample.paths.size();
    const InspectedPath* path = any ? &sample.paths[static_cast<size_t>(picked)] : nullptr;
    add_subpath(light_subpath_of(sample, path), LineKind::light, far, drawing);
    if (path) add_path(*path, far, drawing);
    return drawing;
}

PathDrawing seen_from(const Scene& scene, const Camera& camera, const PathDrawing& drawing,
                      const RenderControl& control) {
    const Eye eye{scene, camera};
    PathDrawing seen;
    seen.marks = drawing.marks;
    for (PathMark& m : seen.marks) m.hidden = !eye.sees(m.at);
    for (const PathLine& line : drawing.lines) {
        if (control.cancelled()) break;
        cut(eye, line, seen.lines);
    }
    return seen;
}

std::optional<vec2> place_on_image(const Camera& c, const Normalisation& n, const dvec3& point) {
    const dvec3 d = (point - n.center) * n.scale - dvec3(c.position);
    const double depth = glm::dot(d, dvec3(c.forward));
    if (!(depth > 0)) return {};
    return vec2(0.5 * c.width + glm::dot(d, dvec3(c.right)) / (depth * c.pixel_size),
                0.5 * c.height - glm::dot(d, dvec3(c.up)) / (depth * c.pixel_size));
}

std::optional<ImageLine> place_on_image(const Camera& c, const Normalisation& n, const dvec3& a,
                                        const dvec3& b) {
    const auto depth = [&](const dvec3& p) {
        return glm::dot((p - n.center) * n.scale - dvec3(c.position), dvec3(c.forward));
    };
    const double da = depth(a), db = depth(b), near = nearest_depth;
    if (da < near && db < near) return {};
    const dvec3 cut = a + (b - a) * ((near - da) / (db - da));
    const auto pa = place_on_image(c, n, da < near ? cut : a);
    const auto pb = place_on_image(c, n, db < near ? cut : b);
    if (!pa || !pb) return {};
    return ImageLine{*pa, *pb};
}

}  // namespace midway
