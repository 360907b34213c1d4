// What passes along an edge that joins two subpaths, with the offsets that keep its ray off the
// surfaces at both ends. The first end is the one towards the camera; every such ray starts there,
// or at the surface where the other end has none (a lens, a point lamp).
#pragma once

#include "integrator/walk.h"

namespace midway {

inline vec3 leave(const PathVertex& v, const vec3& towards) {
    return offset_origin(v.position, v.ng, v.error, towards);
}

inline float edge_visibility(const Scene& scene, const PathVertex& v, const PathVertex& l) {
    return visibility(scene, leave(v, l.position - v.position),
                      offset_end(l.position, l.ng, l.error, v.position));
}

inline float edge_visibility(const Scene& scene, const PathVertex& v, const vec3& lens) {
    return visibility(scene, leave(v, lens - v.position), lens);
}

}  // namespace midway
