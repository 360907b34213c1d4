// Building blocks of the small scenes that the extreme suite and the tests render: meshes,
// materials and lights in code. Units are the file's; every mesh is in world coordinates. Throws
// nothing.
#pragma once

#include "scene/scene_description.h"

namespace midway::extreme {

// n x n cells of two triangles; the front looks along cross(u, v).
Mesh make_quad(const vec3& corner, const vec3& u, const vec3& v, int n = 1);
// A regular polygon with the area of the disc.
Mesh make_disc(const vec3& center, const vec3& normal, float radius, int segments = 256);
// An icosahedron, each triangle split `subdivisions` times into four, on the sphere. Fronts and
// normals look outwards, or inwards.
Mesh make_icosphere(const vec3& center, float radius, int subdivisions, bool inward = false,
                    bool normals = false);

Material lambert(const vec3& albedo);
Material metal(float roughness, const vec3& color = vec3(1));
Material plastic(float roughness, const vec3& color = vec3(1));
Material glass(float roughness, float ior = 1.5f);
Material lamp(const vec3& radiance, const vec3& albedo = vec3(0));

PunctualLight point_light(const vec3& position, float intensity);
// Looks from `position` to `target`; angles in radians.
PunctualLight spot_light(const vec3& position, const vec3& target, float intensity, float inner,
                         float outer);
PunctualLight sun(const vec3& travel, float irradiance);
SkyDescription constant_sky(const vec3& radiance);

// Adds one use of a mesh with a material of its own; returns the instance's id.
int add(SceneDescription& scene, Mesh mesh, const Material& material,
        const dmat4& to_world = dmat4(1.0));

CameraDescription camera_at(const vec3& eye, const vec3& target, double yfov);

}  // namespace midway::extreme
