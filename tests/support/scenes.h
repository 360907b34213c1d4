// Tiny scenes built in code, and renders of them through the whole renderer (build_scene,
// ProgressiveRenderer). Units are the file's; every mesh is in world coordinates.
#pragma once

#include "render/renderer.h"
#include "support/statistics.h"

namespace midway::test {

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

// Throws where the scene cannot be built, or was mended.
std::shared_ptr<const Scene> build(const SceneDescription& scene);

// A square image of `size` pixels through the box filter.
RenderSettings settings(Technique technique, int size = 8, int max_bounces = 16);

// Throws where a sample was not finite or the film overflowed.
Image render(const std::shared_ptr<const Scene>& scene, const CameraDescription& camera,
             const RenderSettings& settings, std::uint64_t passes);

double image_mean(const Image& image);  // of all pixels and channels

// The image's mean from `batches` renders of `passes` passes with seeds of their own.
Estimate batch_mean(const std::shared_ptr<const Scene>& scene, const CameraDescription& camera,
                    RenderSettings settings, std::uint64_t passes, int batches);

}  // namespace midway::test
