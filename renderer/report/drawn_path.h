// Paths as the estimator draws them from a scene, written out in full: every pdf of a path as the
// strategy that drew it saw it, and as each end of the path sees it on its own. For the audit, the
// path inspector and the tests of weights; the estimator itself never needs a whole path.
#pragma once

#include <functional>

#include "integrator/estimator.h"
#include "report/direct_form.h"

namespace midway {

struct DrawnPath {
    PathPdfs pdfs;              // as seen by the strategy that drew the path
    Contribution contribution;  // the estimator's own value and weights
    // Surface vertices 1 .. k-1 (element 0 is unused), and the two ends.
    std::vector<PathVertex> surfaces;
    vec3 lens{0}, light{0};  // `light` is a direction where `infinite`
    bool infinite = false;
    int x = 0, y = 0;  // the pixel it contributes to

    int edges() const { return pdfs.edges(); }
};

// Calls `visit` with every path that the sample of a pixel draws, each with its contribution. A
// path of one edge (a lamp seen directly) has one strategy and no weights to form.
void draw_paths(const Estimator& e, int x, int y, std::uint64_t pass,
                const std::function<void(DrawnPath&)>& visit);

// The same path with each pdf evaluated anew, in float geometry, by a walk through its vertices
// from the camera (Transport::radiance) or from the light. `scatters[i]` tells whether vertex i
// connected to its neighbours has f > 0.
struct OwnPdfs {
    PathPdfs pdfs;
    std::vector<bool> scatters;
};
OwnPdfs own_pdfs(const Estimator& e, const DrawnPath& path, Transport side);

}  // namespace midway
