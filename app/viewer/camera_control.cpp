#include "viewer/camera_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace midway {
namespace {

constexpr double steepest = 89 * std::numbers::pi / 180;
constexpr double dolly_half_life = 0.04, fly_half_life = 0.06;

double elevation(const dvec3& forward) { return std::asin(std::clamp(forward.y, -1.0, 1.0)); }

// The part of a pitch that leaves the view between the poles. A file's camera may stand beyond the
// limit; it can only be turned back.
double allowed_pitch(const dvec3& forward, double pitch) {
    const double now = elevation(forward);
    const double low = std::min(now, -steepest), high = std::max(now, steepest);
    return std::clamp(now + pitch, low, high) - now;
}

// Rodrigues' rotation about a unit axis.
dvec3 rotated(const dvec3& v, const dvec3& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return v * c + glm::cross(axis, v) * s + axis * (glm::dot(axis, v) * (1 - c));
}

struct Turn {
    dvec3 right{1, 0, 0};
    double yaw = 0, pitch = 0;  // about +y, after about `right`
};

dvec3 turned(const dvec3& v, const Turn& t) {
    return rotated(rotated(v, t.right, t.pitch), dvec3(0, 1, 0), t.yaw);
}

Turn turn_of(const View& view, double yaw, double pitch) {
    const ViewBasis b = view_basis(view);
    return {b.right, yaw, allowed_pitch(b.forward, pitch)};
}

// Share of the way that an exponential approach covers.
double share(double seconds, double half_life) { return 1 - std::exp2(-seconds / half_life); }

dvec3 to_file(const Normalisation& n, const vec3& p) { return dvec3(p) / n.scale + n.center; }

std::optional<SurfacePoint> first_surface(const Scene& scene, const dvec3& eye,
                                          const dvec3& direction) {
    const Normalisation& n = scene.geometry->normalisation;
    return intersect(scene, {vec3((eye - n.center) * n.scale), vec3(glm::normalize(direction))}, 0);
}

std::optional<dvec3> first_hit(const Scene& scene, const dvec3& eye, const dvec3& direction) {
    const std::optional<SurfacePoint> p = first_surface(scene, eye, direction);
    if (!p) return {};
    return to_file(scene.geometry->normalisation, p->position);
}

}  // namespace

ViewBasis view_basis(const View& v) {
    const CameraDescription c = look_at({}, v.eye, v.target);
    return {dvec3(c.to_world[0]), dvec3(c.to_world[1]), -dvec3(c.to_world[2])};
}

View view_of(const CameraDescription& c, double distance) {
    const dvec3 eye(c.to_world[3]);
    return {eye, eye - glm::normalize(dvec3(c.to_world[2])) * distance, c.yfov};
}

View view_in(const SceneOptions& o, const CameraDescription& camera, const dvec3& pivot) {
    const double distance = glm::length(pivot - dvec3(camera.to_world[3]));
    View v = view_of(camera, distance > 0 ? distance : 1);
    if (o.look_at) {
        const auto& l = *o.look_at;
        v.eye = {l[0], l[1], l[2]};
        v.target = {l[3], l[4], l[5]};
    }
    if (o.fov_degrees) v.yfov = glm::radians(*o.fov_degrees);
    return v;
}

void use_view(const View& v, const CameraDescription& camera, SceneOptions& o) {
    o.look_at = {v.eye.x, v.eye.y, v.eye.z, v.target.x, v.target.y, v.target.z};
    const double in_use = o.fov_degrees ? glm::radians(*o.fov_degrees) : camera.yfov;
    if (v.yfov != in_use) o.fov_degrees = glm::degrees(v.yfov);
}

dvec3 pixel_direction(const View& v, const Viewport& port, const dvec2& pixel) {
    const ViewBasis b = view_basis(v);
    const double size = 2 * std::tan(v.yfov / 2) / port.height;
    return b.forward + b.right * ((pixel.x - 0.5 * port.width) * size) +
           b.up * ((0.5 * port.height - pixel.y) * size);
}

std::optional<dvec2> project(const View& v, const Viewport& port, const dvec3& point) {
    const ViewBasis b = view_basis(v);
    const dvec3 d = point - v.eye;
    const double along = glm::dot(d, b.forward);
    if (!(along > 0)) return {};
    const double size = 2 * std::tan(v.yfov / 2) / port.height * along;
    return dvec2(0.5 * port.width + glm::dot(d, b.right) / size,
                 0.5 * port.height - glm::dot(d, b.up) / size);
}

double depth_of(const View& v, const dvec3& point) {
    return glm::dot(point - v.eye, view_basis(v).forward);
}

std::optional<dvec3> surface_at(const Scene& scene, const View& view, const Viewport& port,
                                const dvec2& pixel) {
    return first_hit(scene, view.eye, pixel_direction(view, port, pixel));
}

std::optional<PickedObject> object_at(const Scene& scene, const View& view, const Viewport& port,
                                      const dvec2& pixel) {
    const auto p = first_surface(scene, view.eye, pixel_direction(view, port, pixel));
    if (!p) return {};
    return PickedObject{p->hit.object, to_file(scene.geometry->normalisation, p->position)};
}

dvec3 natural_pivot(const Scene& scene, const View& view) {
    const dvec3 forward = view_basis(view).forward;
    if (const std::optional<dvec3> hit = first_hit(scene, view.eye, forward)) return *hit;
    const dvec3 center = scene.geometry->normalisation.center;
    const double along = glm::dot(center - view.eye, forward);
    return view.eye + forward * (along > 0 ? along : scene_radius(scene));
}

double scene_radius(const Scene& scene) {
    return scene.geometry->radius / scene.geometry->normalisation.scale;
}

View orbit(const View& view, const dvec3& pivot, const dvec2& drag, const Viewport& port) {
    const double per_pixel = std::numbers::pi / port.height;
    const Turn t = turn_of(view, -drag.x * per_pixel, -drag.y * per_pixel);
    View next = view;
    next.eye = pivot + turned(view.eye - pivot, t);
    next.target = next.eye + turned(view.target - view.eye, t);
    return next;
}

View look_around(const View& view, const dvec2& drag, const Viewport& port) {
    const double per_pixel = 2 * std::tan(view.yfov / 2) / port.height;
    const Turn t = turn_of(view, -drag.x * per_pixel, -drag.y * per_pixel);
    View next = view;
    next.target = view.eye + turned(view.target - view.eye, t);
    return next;
}

View pan(const View& view, const Viewport& port, const dvec3& held, const dvec2& pixel) {
    const double depth = depth_of(view, held);
    if (!(depth > 0)) return view;
    const dvec3 shift = held - (view.eye + pixel_direction(view, port, pixel) * depth);
    return {view.eye + shift, view.target + shift, view.yfov};
}

View dolly(const View& view, const dvec3& towards, double factor, double radius) {
    const double distance = glm::length(view.eye - towards);
    if (!(distance > 0)) return view;
    // A view beyond a limit already may only come back.
    const double low = std::min(1e-4 * radius / distance, 1.0);
    const double high = std::max(1e3 * radius / distance, 1.0);
    factor = std::clamp(factor, low, high);
    return {towards + (view.eye - towards) * factor, towards + (view.target - towards) * factor,
            view.yfov};
}

View frame(const View& view, const Bounds& bounds, double aspect) {
    const ViewBasis b = view_basis(view);
    const dvec3 center = 0.5 * (bounds.lower + bounds.upper);
    const double margin = 1.06;
    const double half_y = std::tan(view.yfov / 2) / margin, half_x = half_y * aspect;
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 p = dvec3(corner & 1 ? bounds.upper.x : bounds.lower.x,
                              corner & 2 ? bounds.upper.y : bounds.lower.y,
                              corner & 4 ? bounds.upper.z : bounds.lower.z) -
                        center;
        const double needed =
            std::max(std::abs(glm::dot(p, b.right)) / half_x, std::abs(glm::dot(p, b.up)) / half_y);
        distance = std::max(distance, needed - glm::dot(p, b.forward));
    }
    if (!(distance > 0)) distance = 1;
    return {center - b.forward * distance, center, view.yfov};
}

View advance(DollyGlide& glide, const View& view, double radius, double seconds) {
    double step = glide.log_factor * share(seconds, dolly_half_life);
    if (std::abs(glide.log_factor - step) < 2e-3) step = glide.log_factor;
    glide.log_factor -= step;
    return dolly(view, glide.towards, std::exp(step), radius);
}

View glide_view(const ViewGlide& g) {
    const double t = std::clamp(g.elapsed / glide_seconds, 0.0, 1.0);
    if (t == 1) return g.to;
    const double s = t * t * (3 - 2 * t);
    const dvec3 a = g.from.eye - g.from.target, b = g.to.eye - g.to.target;
    const double la = glm::length(a), lb = glm::length(b);
    // Opposite directions have no middle; any turn serves.
    const double cosine = std::clamp(glm::dot(a, b) / (la * lb), -1.0, 1.0);
    const double angle = std::acos(cosine);
    dvec3 axis = glm::cross(a, b);
    axis = glm::length(axis) > 1e-9 * la * lb ? glm::normalize(axis) : view_basis(g.from).up;
    View v;
    v.target = glm::mix(g.from.target, g.to.target, s);
    v.eye = v.target + rotated(a / la, axis, angle * s) * (la * std::pow(lb / la, s));
    v.yfov = glm::mix(g.from.yfov, g.to.yfov, s);
    return v;
}

View fly(const View& view, dvec3& velocity, const FlyInput& in, double seconds) {
    const ViewBasis b = view_basis(view);
    dvec3 wish = b.forward * in.forward + b.right * in.right + dvec3(0, 1, 0) * in.up;
    if (glm::length(wish) > 1) wish = glm::normalize(wish);
    wish *= in.speed;
    // The exact solution of dv/dt = rate (wish - v), so that steps of any length agree.
    const double rate = std::log(2.0) / fly_half_life, arrived = share(seconds, fly_half_life);
    const dvec3 way = wish * seconds + (velocity - wish) * (arrived / rate);
    velocity += (wish - velocity) * arrived;
    return {view.eye + way, view.target + way, view.yfov};
}

bool is_moving(const dvec3& velocity, const FlyInput& in) {
    return in.forward != 0 || in.right != 0 || in.up != 0 ||
           glm::length(velocity) > 0.01 * in.speed;
}

}  // namespace midway
