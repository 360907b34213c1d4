// Textures that change nothing, in the places of materials that have none: what leaving out
// textures (and transmission) saves is what looking these up costs.
#pragma once

#include "scene/scene.h"

namespace midway {

// Materials and textures of the scene are there. White ones give the very bits that none give, and
// so do black ones for transmission; flat normal maps turn a normal by its rounding at most. Left
// alone are emission, whose tables would be others, and places where a texture might tell surfaces
// apart that are alike (scene_features() in render/coverage.h).
void add_needless_textures(Scene& scene, const NeedlessWork& needless);

}  // namespace midway
