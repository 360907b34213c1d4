// Ends of the rays of edges, with the offsets of edge.h.
#pragma once

#include "scene/rounding.h"
#include "scene/surface_lanes.h"

namespace midway {

inline Vec3x8 leave(const SurfaceLanes& p, const Vec3x8& towards) {
    return offset_origin(p.position, p.bsdf.ng, p.error, towards);
}
inline Vec3x8 arrive_at(const SurfaceLanes& p, const Vec3x8& from) {
    return offset_end(p.position, p.bsdf.ng, p.error, from);
}

}  // namespace midway
