// The Bsdfs of eight surface points side by side (bsdf.h). Lambert's lobe alone, which is what most
// surfaces have, is done for all lanes at once; lanes with other lobes go through bsdf.h one by
// one. Both ways give the same bits.
#pragma once

#include <array>

#include "math/lanes.h"
#include "shading/bsdf.h"

namespace midway {

struct BsdfLanes {
    Vec3x8 ng;                                    // geometric normal of the front side
    Vec3x8 normal;                                // shading normal, on the side of ng
    Vec3x8 diffuse;                               // albedo; zero in lanes with other lobes
    Mask8 others{};                               // lanes that have other lobes than Lambert's
    std::array<const Bsdf*, lane_count> other{};  // in those lanes, kept by whoever made this
};
using BsdfStore = std::array<Bsdf, lane_count>;

// Where two directions chosen by somebody else can have f > 0.
Mask8 connectible(const BsdfLanes& b);

// As eval_bsdf(), for the lanes that are wanted.
struct BsdfEval8 {
    Vec3x8 f;
    Float8 pdf_fwd_w, pdf_rev_w;
};
BsdfEval8 eval_bsdfs(const BsdfLanes& b, const Mask8& wanted, const Vec3x8& from, const Vec3x8& to,
                     Transport transport);

// As sample_bsdf().
struct BsdfSample8 {
    Mask8 drawn;
    Mask8 delta;
    Vec3x8 to, weight;
    Float8 pdf_fwd_w, pdf_rev_w, eta_scale;
};
BsdfSample8 sample_bsdfs(const BsdfLanes& b, const Mask8& wanted, const Vec3x8& from,
                         const Vec3x8& u, Transport transport);

}  // namespace midway
