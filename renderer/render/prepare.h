// From a file and a person's wishes to a scene that is ready to trace.
#pragma once

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
    SceneDescription description;
    CameraDescription camera;
    std::shared_ptr<const Scene> scene;
    std::vector<std::string> warnings;
    std::uint64_t hash = 0;  // of the scene and the camera
    double seconds_load = 0, seconds_build = 0;
};

// Throws one line: std::runtime_error where the file cannot be rendered, std::invalid_argument where
// the wishes make no sense.
PreparedScene prepare_scene(const SceneOptions& options);

}  // namespace midway
