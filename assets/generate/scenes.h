// The scenes of assets/, one function each; assets/README.md says what they show.
#pragma once

#include "gltf.h"

namespace midway::assets {

Scene cornell();
Scene plates();
Scene five_lights();
Scene idol();
Scene ajar();
Scene ring();
Scene lanterns();
Scene terrace();

// Throws std::runtime_error with one line where faces of different materials lie upon each other
// and look the same way: rounding would decide which of them a ray meets, from every side another.
void check_scene(const Scene& scene);

// Sky map of `terrace` as a Radiance RGBE file (Ward 1991), without the sun's disc.
std::string terrace_sky();

}  // namespace midway::assets
