// What a person chose in the strategy pyramid (panels/pyramid.cpp). Part of how the image is shown:
// nothing here restarts a render.
#pragma once

#include <vector>

#include "integrator/strategy.h"

namespace midway {

enum class PyramidShare { light, noise, rays };

struct PyramidChoices {
    bool open = false;
    bool bare = false;                         // estimates before their MIS weight
    bool own_exposure = false;                 // each thumbnail as bright as suits it
    PyramidShare share = PyramidShare::light;  // what the bars show
    std::vector<Strategy> selected;            // shown in the view as one sum; none: the image
    std::vector<Strategy> seen;                // chosen before, the latest first
    bool operator==(const PyramidChoices&) const = default;
};

}  // namespace midway
