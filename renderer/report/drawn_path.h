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
    int light_id = -1;  // of the scene
    int x = 0, y = 0;   // the pixel it contributes to
    int met = -1;  // of a connection: whose light subpath it meets, by place in DrawnSample::lights

    int edges() const { return pdfs.edges(); }
};

// What scattering at a vertex drew: densities of the way on, and of the way back.
struct Scattering {
    float fwd = 0, rev = 0;  // per solid angle; for a delta lobe discrete probabilities
    bool delta = false;
};

// One end's walk; element i belongs to vertex i counted from that end, element 0 is unused. Where
// the walk did not leave its last vertex, `scattered` is one shorter than `vertices`.
struct RecordedWalk {
    Walk start, now;
    std::vector<PathVertex> vertices{1};
    std::vector<Scattering> scattered{1};
    std::vector<TriangleHit> hits{1};
    bool escaped = false;  // the last ray left the scene, in direction now.ray.direction
};

struct DrawnSample {
    RecordedWalk camera;
    // Of the whole group that shares them, by place; empty where the families use none, or where it
    // carries nothing.
    std::vector<std::optional<RecordedWalk>> lights;
    int place = 0;  // of this sample in the group

    const std::optional<RecordedWalk>& light() const { return lights[static_cast<size_t>(place)]; }
};

// Calls `visit` with every path that the sample of a pixel draws, each with its contribution, and
// also for families that are not in use; in the order of estimate_alone(). A path of one edge (a
// lamp seen directly) has one strategy and no weights to form.
DrawnSample draw_paths(const Estimator& e, int x, int y, std::uint64_t pass,
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
