// Pinhole and thin-lens camera in scene space. Film positions are continuous pixel coordinates: (0,
// 0) is the upper left corner of the image, y grows downwards.
#pragma once

#include <optional>

#include "math/lanes.h"
#include "scene/accel.h"
#include "scene/scene_description.h"

namespace midway {

struct Camera {
    vec3 position{0};
    vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
    float lens_radius = 0;
    float focus_distance = 1;
    float pixel_size = 1;  // of a pixel on the plane at distance 1
    int width = 1, height = 1;
};

Camera make_camera(const CameraDescription& description, const Normalisation& normalisation,
                   int width, int height);

// Point on the lens for a random pair; the pinhole itself where lens_radius is 0.
vec3 lens_point(const Camera& camera, const vec2& u);

// Unit direction from a lens point to what the film position sees in focus.
vec3 camera_direction(const Camera& camera, const vec3& lens, const vec2& film);

// The same for eight of them; lens points of the lanes that are wanted.
Vec3x8 lens_points(const Camera& camera, const Mask8& wanted, const Float8& u, const Float8& v);
Vec3x8 camera_directions(const Camera& camera, const Vec3x8& lens, const Float8& x,
                         const Float8& y);

// Where the direction from a lens point lands on the film (perhaps outside of the image); empty for
// directions that point backwards.
inline std::optional<vec2> film_position(const Camera& c, const vec3& lens, const vec3& direction) {
    const float along = glm::dot(direction, c.forward);
    if (!(along > 0)) return {};
    vec3 p = direction / along;
    if (c.lens_radius > 0) p = (lens - c.position) / c.focus_distance + p;
    return vec2(0.5f * c.width + glm::dot(p, c.right) / c.pixel_size,
                0.5f * c.height - glm::dot(p, c.up) / c.pixel_size);
}

// Density per solid angle of one sample drawn uniformly over one pixel's area; cos_theta against
// the view axis. The density of light tracing's splats and of eq. (22) is this times the sample
// count.
template <class F>
F camera_pdf_w(const Camera& camera, const F& cos_theta) {
    return 1.0f / (sqr(camera.pixel_size) * cos_theta * cos_theta * cos_theta);
}

// A camera that frames the whole scene, for files that hold none.
CameraDescription frame_scene(const dvec3& lower, const dvec3& upper);

// A camera at `eye` that looks at `target` with +y up, other properties as in `like`.
CameraDescription look_at(CameraDescription like, const dvec3& eye, const dvec3& target);

}  // namespace midway
