// What a render of a scene leaves out because the scene does not need it: found at load from what
// is there, before any sample. Each line names work that is really not done; nothing in an image
// changes by it.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace midway {

struct LeaveOut {
    std::string what;  // one of a fixed set of words
    std::string why;   // in words that fit after "what: "
};

std::vector<LeaveOut> leave_outs(const Scene& scene);

}  // namespace midway
