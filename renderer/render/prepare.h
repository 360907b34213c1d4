// From a file and a person's wishes to a scene that is ready to trace.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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
};

struct PreparedScene {
    SceneOptions options;  // that it was made with
    SceneDescription description;
    CameraDescription camera;
    std::shared_ptr<const Scene> scene;
    std::vector<std::string> warnings;        // all of them
    std::vector<std::string> scene_warnings;  // those of building the Scene
    bool default_sky = false;                 // the file and the wishes hold no light
    std::uint64_t content_hash = 0;           // of the meshes and images
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
// shared (a new camera keeps the Scene, a new sky keeps geometry and tree). Throws as above, or
// where the path differs.
PreparedScene update_scene(const PreparedScene& old, const SceneOptions& options);

}  // namespace midway
