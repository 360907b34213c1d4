#include <fmt/format.h>

#include "commands.h"

namespace midway {

void add_scene_options(CLI::App& c, SceneOptions& o) {
    c.add_option("scene", o.path, "Scene: .gltf, .glb or a session .midway")->required();
    c.add_option("--sky", o.sky, "Sky: an .hdr or .exr map, or a colour R,G,B");
    c.add_option("--sky-rotation", o.sky_rotation_degrees, "Rotation of the sky about +y, degrees");
    c.add_option("--sky-strength", o.sky_strength, "Factor on the sky");
    c.add_option("--lamp-strength", o.lamp_strength, "Factor on every light but the sky");
    c.add_option("--camera", o.camera, "Camera of the file: name or index");
    c.add_option("--look-at", o.look_at, "Eye and target: EX,EY,EZ,TX,TY,TZ")->delimiter(',');
    c.add_option("--fov", o.fov_degrees, "Vertical field of view, degrees");
    c.add_option("--aperture", o.aperture_radius, "Radius of the thin lens, scene units");
    c.add_option("--focus", o.focus_distance, "Distance of the plane in focus, scene units");
}

void print_warnings(const std::vector<std::string>& warnings) {
    for (const std::string& w : warnings) fmt::print(stderr, "midway: warning: {}\n", w);
}

}  // namespace midway
