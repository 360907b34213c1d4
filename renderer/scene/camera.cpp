#include "scene/camera.h"

#include "math/warp.h"

namespace midway {

Camera make_camera(const CameraDescription& d, const Normalisation& n, int width, int height) {
    Camera c;
    c.position = vec3((dvec3(d.to_world[3]) - n.center) * n.scale);
    const dvec3 forward = -glm::normalize(dvec3(d.to_world[2]));
    const dvec3 right = glm::normalize(glm::cross(forward, dvec3(d.to_world[1])));
    c.forward = vec3(forward);
    c.right = vec3(right);
    c.up = vec3(glm::cross(right, forward));
    c.lens_radius = static_cast<float>(d.aperture_radius * n.scale);
    c.focus_distance = static_cast<float>(d.focus_distance * n.scale);
    if (!(c.focus_distance > 0))
        c.focus_distance = std::max(1e-3f, glm::dot(-c.position, c.forward));
    c.pixel_size = static_cast<float>(2 * std::tan(d.yfov / 2) / height);
    c.width = width;
    c.height = height;
    return c;
}

vec3 lens_point(const Camera& c, const vec2& u) {
    if (c.lens_radius == 0) return c.position;
    const vec2 p = square_to_disc(u) * c.lens_radius;
    return c.position + c.right * p.x + c.up * p.y;
}

vec3 camera_direction(const Camera& c, const vec3& lens, const vec2& film) {
    const vec3 through_center = c.forward + c.right * ((film.x - 0.5f * c.width) * c.pixel_size) +
                                c.up * ((0.5f * c.height - film.y) * c.pixel_size);
    if (c.lens_radius == 0) return glm::normalize(through_center);
    return glm::normalize(c.position + through_center * c.focus_distance - lens);
}

Vec3x8 lens_points(const Camera& c, const Mask8& wanted, const Float8& u, const Float8& v) {
    Vec3x8 lens = all_lanes(c.position);
    if (c.lens_radius != 0)
        for_each_lane(wanted, [&](int k) { lens.set(k, lens_point(c, {u[k], v[k]})); });
    return lens;
}

Vec3x8 camera_directions(const Camera& c, const Vec3x8& lens, const Float8& x, const Float8& y) {
    const Vec3x8 through_center = all_lanes(c.forward) +
                                  all_lanes(c.right) * ((x - 0.5f * c.width) * c.pixel_size) +
                                  all_lanes(c.up) * ((0.5f * c.height - y) * c.pixel_size);
    if (c.lens_radius == 0) return normalize(through_center);
    return normalize(all_lanes(c.position) + through_center * all_lanes(c.focus_distance) - lens);
}

CameraDescription look_at(CameraDescription like, const dvec3& eye, const dvec3& target) {
    const dvec3 back = glm::normalize(eye - target);
    // Straight up or down there is no horizon; any right vector serves.
    const dvec3 up = std::abs(back.y) > 0.99999 ? dvec3(0, 0, back.y > 0 ? -1 : 1) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(up, back));
    like.to_world =
        dmat4(dvec4(right, 0), dvec4(glm::cross(back, right), 0), dvec4(back, 0), dvec4(eye, 1));
    return like;
}

CameraDescription frame_scene(const dvec3& lower, const dvec3& upper) {
    CameraDescription d;
    d.name = "framing";
    d.yfov = 0.7;
    const dvec3 center = 0.5 * (lower + upper);
    const dvec3 back = glm::normalize(dvec3(0.55, 0.4, 1.0));
    const CameraDescription oriented = look_at(d, center + back, center);
    const dvec3 right(oriented.to_world[0]), up(oriented.to_world[1]);
    // Move back until all eight corners of the bounds lie inside a square image with a margin.
    const double half = std::tan(d.yfov / 2) / 1.08;
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 p = dvec3(corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y,
                              corner & 4 ? upper.z : lower.z) -
                        center;
        const double side = std::max(std::abs(glm::dot(p, right)), std::abs(glm::dot(p, up)));
        distance = std::max(distance, side / half + glm::dot(p, back));
    }
    if (!(distance > 0)) distance = 1;
    return look_at(d, center + back * distance, center);
}

}  // namespace midway
