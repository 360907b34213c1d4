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

// Sky map of `terrace` as a Radiance RGBE file (Ward 1991), without the sun's disc.
std::string terrace_sky();

}  // namespace midway::assets
