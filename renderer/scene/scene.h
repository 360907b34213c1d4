// A scene frozen for tracing: const while any worker runs. build_scene() makes one from a
// SceneDescription; the geometry, its tree and the textures are shared with the Scenes of later
// edits.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/accel.h"
#include "scene/camera.h"
#include "scene/lamps.h"
#include "scene/light.h"
#include "scene/light_tree.h"
#include "scene/scene_description.h"

namespace midway {

// Of one object: for each triangle the share of the material's emission that textures and coverage
// leave on the average.
using EmissionMeans = std::shared_ptr<const std::vector<vec3>>;

struct Scene {
    std::shared_ptr<const Geometry> geometry;
    std::shared_ptr<const Accel> accel;
    std::vector<Material> materials;
    TextureSet textures;
    // Of each object the Bsdf that it has everywhere, but for the frame and the normals; none where
    // textures or colours vary it.
    std::vector<std::optional<Bsdf>> even_surfaces;
    std::vector<Light> lights;     // area lights first
    LampTriangles lamps;           // of the area lights
    Distribution1D emission_pick;  // by power; of a parallelogram, its first triangle for both
    // Next event asks one of the lights at infinity or, entry 0, the tree about all others; by
    // power, with a share spread evenly over the lights. The tree too holds first triangles.
    Distribution1D next_event_group;
    std::vector<int> infinite_lights;  // entries 1, 2, ...
    LightTree light_tree;
    std::optional<Sky> sky;
    int sky_light = -1;
    std::vector<int> first_light;  // of each object: the light of its triangle 0, or -1
    std::vector<EmissionMeans> emission_means;  // of each object, null where they are one
    float radius = 1;             // of the bounding disc that infinite lights emit from
    double total_power = 0;       // of all lights, mean of RGB, in scene units
    double same_lamp = 0;         // probability that two lights picked by power are one lamp's
    size_t unreached_lights = 0;  // shine, and on no surface: they are never picked
    double unreached_power = 0;
    bool has_transparency = false;
};

// Work that a scene leaves out because nothing in it needs it. What is true here is done all the
// same: it takes time and changes no image, so that the time can be measured (report/cost.h).
struct NeedlessWork {
    bool attributes = false;   // texture coordinates and tangents that no texture asks for are kept
    bool textures = false;     // white ones are looked up where a material has none
    bool normal_maps = false;  // the same of flat ones
    bool coverage = false;     // rays ask opaque triangles how opaque they are
    bool lights = false;       // lights that reach nothing are picked too
    bool black_lights = false;  // black ones are picked as often as if each had the mean power
    bool sky = false;           // rays that leave the scene look up a black sky
    bool transmission = false;  // opaque materials let light through by a black texture
};

struct BuildOptions {
    // A scene built from the same meshes and instances: its geometry and tree are shared where the
    // materials allow it. Built without needless work.
    const Scene* previous = nullptr;
    bool normalise = true;  // false: traced in the file's coordinates, for tests
    NeedlessWork needless = {};
};

// Throws std::runtime_error with one line for a scene that cannot be traced. Lines for things that
// were mended or left out are appended to `warnings`.
Scene build_scene(const SceneDescription& description, std::vector<std::string>& warnings,
                  const BuildOptions& options = {});

// Bounds of all instances in the file's coordinates; empty where there is no geometry.
struct Bounds {
    dvec3 lower{0}, upper{0};
};
std::optional<Bounds> scene_bounds(const SceneDescription& description);

// Hash of everything in a description and a camera that can change an image. `content` is the large
// part, which edits of lights and materials keep: hash_content() of meshes and images, gone on with
// by hash_sky_map() where the sky has a map.
std::uint64_t hash_content(const SceneDescription& description);
std::uint64_t hash_sky_map(std::uint64_t content, const Image& map);
std::uint64_t hash_scene(std::uint64_t content, const SceneDescription& description,
                         const CameraDescription& camera);

// Where a ray met the scene; empty where it left it.
std::optional<SurfacePoint> surface_at(const Scene& scene, const TriangleHit& hit);

// What a ray meets first; empty where it leaves the scene. `coin` decides about transparency.
std::optional<SurfacePoint> intersect(const Scene& scene, const Ray& ray, std::uint64_t coin);

// What passes between two points, each given with the offset that keeps the ray off its own
// surface.
float visibility(const Scene& scene, const vec3& from, const vec3& to);
// What passes from a point into the open.
float visibility_to_infinity(const Scene& scene, const vec3& from, const vec3& direction);

inline const Material& material_at(const Scene& scene, const SurfacePoint& p) {
    return scene.materials[scene.geometry->objects[p.hit.object].material];
}

// Empty where the sample carries nothing. Picks have more bits than a float, so that each of many
// lights has its own probability.
struct EmissionNumbers {
    double pick = 0;
    vec2 point{0}, direction{0};
};
std::optional<EmissionSample> sample_emission(const Scene& scene, const EmissionNumbers& u);

struct NextEventNumbers {
    double pick = 0;
    vec2 point{0};
};
std::optional<NextEventSample> sample_next_event(const Scene& scene, const vec3& reference,
                                                 const NextEventNumbers& u);

// How much likelier next event at `reference` picks a light than emission does.
double next_event_ratio(const Scene& scene, int light, const LightEdge& edge);

// What the surface emits towards `towards`, with its densities; those of next event at `reference`.
// Empty where it emits nothing there.
std::optional<EmitterHit> emitter_hit(const Scene& scene, const SurfacePoint& p,
                                      const vec3& towards, const vec3& reference);

// The same for a ray that left the scene in `direction`.
std::optional<EmitterHit> sky_hit(const Scene& scene, const vec3& direction);

}  // namespace midway
