// Eight surface points at once, with their Bsdfs: as surface_at() and make_bsdf() make them one by
// one, with the same bits.
#pragma once

#include "scene/scene.h"
#include "shading/bsdf_lanes.h"

namespace midway {

struct SurfaceLanes {
    Vec3x8 position;
    Float8 error;  // of position, as in SurfacePoint
    BsdfLanes bsdf;
};

// Of the lanes that met a triangle. What is too large for lanes is put into `store`.
void surfaces_at(const Scene& scene, const HitLanes& hits, const Mask8& met, SurfaceLanes& s,
                 BsdfStore& store);

}  // namespace midway
