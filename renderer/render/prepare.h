// From a file and a person's wishes to a scene that is ready to trace.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/scene_edits.h"
#include "scene/scene.h"

namespace midway {

// Changes to what the file says; what is absent stays as in the file.
struct SceneOptions {
    std::string path;
    std::optional<std::string> sky;  // file name, or "R,G,B"
    double sky_rotation_degrees = 0;
    float sky_strength = 1;
    float lamp_strength = 1;
    std::optional<std::string> camera;             // name or index
    std::optional<std::array<double, 6>> look_at;  // eye, target; in the file's units
    std::optional<double> fov_degrees;             // vertical
    std::optional<double> aperture_radius;
    std::optional<double> focus_distance;
    SceneEdits edits;  // of single lights and materials
};

// What edits start from: the file's own.
struct FileContents {
    std::vector<Material> materials;
    std::vector<PunctualLight> lights;
    bool shines = false;  // there is a lamp or a material that shines
};

struct PreparedScene {
    SceneOptions options;          // that it was made with
    SceneDescription description;  // of the file, with the wishes
    std::shared_ptr<const FileContents> file;
    std::optional<SkyDescription> sky;  // as chosen: before rotation, strength and edits
    CameraDescription camera;
    std::shared_ptr<const Scene> scene;
    std::vector<std::string> warnings;        // all of them
    std::vector<std::string> light_warnings;  // those of the wishes about lights and materials
    std::vector<std::string> scene_warnings;  // those of building the Scene
    bool default_sky = false;                 // the file and the wishes hold no light
    std::uint64_t content_hash = 0;           // of the meshes and images
    std::uint64_t sky_hash = 0;               // the same gone on with by the map of `sky`
    std::uint64_t hash = 0;                   // of the scene and the camera
    double seconds_load = 0, seconds_build = 0;
};

// What a load is at, and how much of it is done; called by the thread that loads. A loader is
// stopped by throwing out of it.
using LoadProgress = std::function<void(const char* stage, double done)>;

// Throws one line: std::runtime_error where the file cannot be rendered, std::invalid_argument
// where the wishes make no sense.
PreparedScene prepare_scene(const SceneOptions& options, const LoadProgress& progress = {});

// The same file with other wishes: nothing is read again, and all that the change leaves alone is
// shared (a new camera keeps the Scene, a new sky keeps geometry and tree). The result is that of
// prepare_scene, to the bit, whatever the wishes were before. Throws as above, or where the path
// differs.
PreparedScene update_scene(const PreparedScene& old, const SceneOptions& options,
                           const LoadProgress& progress = {});

// Whether two wishes about a file differ in the camera alone.
bool same_scene(const SceneOptions& a, const SceneOptions& b);

// `old` with the lights, materials and sky of `wishes`, or with its camera.
SceneOptions with_scene_of(const SceneOptions& wishes, SceneOptions old);
SceneOptions with_camera_of(const SceneOptions& wishes, SceneOptions old);

}  // namespace midway
