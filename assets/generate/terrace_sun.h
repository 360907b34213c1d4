// Where the sun of `terrace` stands: shared by its directional light and its sky map.
#pragma once

#include "mesh.h"

namespace midway::assets {

inline dvec3 to_terrace_sun() { return glm::normalize(dvec3(-0.64, 0.50, -0.66)); }

}  // namespace midway::assets
