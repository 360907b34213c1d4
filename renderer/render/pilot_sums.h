// The samples of the pilot (render/pilot.h) and what they tell of every plan that is weighed up.
// Sums are kept apart by chunk of samples and added in the chunks' order, so that they do not
// depend on threads.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "integrator/estimator.h"
#include "render/render_control.h"
#include "render/settings.h"

namespace midway {

// Places of the samples: strata of the crop, a pair of samples in each.
inline constexpr int pilot_columns = 256, pilot_rows = 64;
inline constexpr int pilot_samples = 2 * pilot_columns * pilot_rows;

inline constexpr size_t most_candidates = 8;
struct Candidates {
    std::array<Plan, most_candidates> plans;
    int count = 0;
    bool splats_direct = true;  // of the plans with light tracing
    void add(const Families& f, int quarters) {
        plans[count++] = {f, quarters, splats_direct || !f.light_tracing};
    }
};

// Contributions that a camera sample has at most one or a few of, and that vary apart: by family
// and length of the path.
inline constexpr int lengths = 3, groups = 3 * lengths;  // up to 2 edges, 3, more
inline int length_group(const Strategy& k) { return std::clamp(k.edges() - 2, 0, lengths - 1); }
using Energies = std::array<double, groups>;

struct BlockSums {
    double image = 0;         // of luminance
    double splat_square = 0;  // of the full plan's splats
    // Of each plan: what its second moment has more than the full one's, and what its camera
    // samples gather of the image.
    std::array<double, most_candidates> excess{};
    std::array<Energies, most_candidates> energy{};
    Energies full_energy{};
};

struct Pair {
    double square = 0;  // of the difference of the two samples' luminances
    int block = 0;
};

struct PilotSums {
    std::vector<BlockSums> blocks;
    std::vector<Pair> pairs;
    RayCounts camera, light;
    std::vector<std::uint64_t> shadow_rays;  // by strategy_index
};

// The image is known coarsely: in blocks, at most 32 a side.
struct Grid {
    static constexpr int most_a_side = 32;
    PixelRect crop;
    int x = 1, y = 1;
    explicit Grid(const PixelRect& c)
        : crop(c), x(std::min(most_a_side, c.width())), y(std::min(most_a_side, c.height())) {}
    int block(int px, int py) const {
        return static_cast<int>(std::int64_t{py - crop.y0} * y / crop.height()) * x +
               static_cast<int>(std::int64_t{px - crop.x0} * x / crop.width());
    }
};

// Light subpaths per pixel.
inline double light_share(const Plan& plan) { return plan.light_quarters / 4.0; }

// Binds the pilot's samples to a scene; throws as make_estimator().
Estimator pilot_estimator(const Scene& scene, const CameraDescription& camera,
                          RenderSettings settings);

// Nothing where `control` ended it. `threads` 0: all processors.
std::optional<PilotSums> sample_pilot(const Estimator& estimator, const Grid& grid,
                                      const Candidates& candidates, int threads,
                                      const RenderControl* control);

}  // namespace midway
