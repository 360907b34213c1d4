// The lights of a Scene and the tables that they are picked from: one light for each triangle of a
// material that shines, one for each lamp without size, one for the sky. Powers are means of RGB in
// scene units. Time and memory grow with the number of lights and no faster.
#pragma once

#include "scene/scene.h"

namespace midway {

// Fills in everything of a scene that shines; its geometry, materials, textures and radius are
// there. What does not depend on how strongly lights shine is shared with options.previous: the
// sky's table, the means of textures over triangles, and which lights reach a surface at all.
// Throws std::runtime_error with one line where the sum of all powers is not finite.
void build_lights(Scene& scene, const SceneDescription& description, const BuildOptions& options);

}  // namespace midway
