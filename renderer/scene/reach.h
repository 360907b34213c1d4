// Which lights can reach a surface at all. A lamp's triangle that shines by its front alone and has
// the whole scene behind it, or a spot whose cone passes by everything, adds nothing to any path
// but the one on which the camera sees it: to pick it, for next event or as the start of a light
// subpath, is a sample lost. What is found is certain: vertices for triangles, bounds for cones; a
// light that is only hidden behind something still counts as reaching.
#pragma once

#include "scene/scene.h"

namespace midway {

// Sets Light::reaches; the scene's geometry and lights are there. The search
// ends after a number of steps, and what it has not come to counts as reaching.
void find_reach(Scene& scene);

}  // namespace midway
