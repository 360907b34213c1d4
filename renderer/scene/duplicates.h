// Triangles that are there twice: same corners in the same order round, same material. A ray meets
// one of them only, but a lamp would be sampled once for each, and techniques would disagree.
#pragma once

#include "scene/geometry.h"

namespace midway {

// Takes all but the first of such triangles out of opaque objects; returns how many. Objects may be
// left without triangles.
size_t remove_duplicate_triangles(std::vector<Object>& objects);

}  // namespace midway
