// The project's own scenes, by name.
#pragma once

#include <string>

#include "render/prepare.h"

namespace midway::test {

// "cornell.glb", as it is: no wishes beside the file.
inline SceneOptions of_asset(const std::string& name) {
    SceneOptions o;
    o.path = std::string(MIDWAY_SOURCE_DIR) + "/assets/" + name;
    return o;
}

}  // namespace midway::test
