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

// Places of the samples: strata of the crop, with a pixel in each. A pixel has the passes of a
// render, eight even and eight odd ones: what stratification saves is seen (Owen-Sobol numbers make
// next event's noise fall faster than that of connections and splats, whose places are by chance).
inline constexpr int pilot_columns = 64, pilot_rows = 64, pilot_passes = 16;
inline constexpr int pilot_pixels = pilot_columns * pilot_rows;
inline constexpr int pilot_samples = pilot_pixels * pilot_passes;

inline constexpr size_t most_candidates = 20;
struct Candidates {
    // Behind them the full one, and what the pilot samples: the same with direct light sampled
    // twice. Without the second samples it is the full one.
    std::array<Plan, most_candidates + 2> plans;
    int count = 0;
    bool splats_direct = true;  // of the plans with light tracing

    int full() const { return count; }
    int sampled() const { return count + 1; }

    void add(const Families& f, int quarters) {
        plans[count++] = {f, quarters, splats_direct || !f.light_tracing};
    }
    // Ends the list: each once more with direct light sampled twice, and what lies behind them.
    void end(const Families& all) {
        const int unsplit = all.next_event ? count : 0;
        for (int i = 0; i < unsplit; ++i) plans[count++] = split(plans[i]);
        plans[full()] = {all, all.needs_light_subpaths() ? 4 : 0};
        plans[sampled()] = split(plans[full()]);
    }

  private:
    static Plan split(Plan p) {
        p.direct_samples = 2;
        return p;
    }
};

// Contributions that a camera sample has at most one or a few of, and that vary apart: by family
// and length of the path.
inline constexpr int lengths = 3, groups = 4 * lengths;  // up to 2 edges, 3, more
inline int group_of(Family f, int edges) {
    return int(f) * lengths + std::clamp(edges - 2, 0, lengths - 1);
}
using Moments = std::array<double, groups>;
// One number for each plan: side by side, since all are summed at once.
using ByPlan = std::array<double, most_candidates + 2>;

// Sums over what the samples find in a block.
struct BlockSums {
    double image = 0;  // of luminance
    // How a plan's strategies would share it, and their second moments.
    std::array<ByPlan, groups> first{}, second{};
    ByPlan largest{};  // of one contribution, to all second moments together
};

// Variances per sample of what the pilot's camera samples gather, from the halves of the passes.
struct GatheredVariances {
    double all = 0;
    Moments groups{};
};
// Of the full plan, and of the one with direct light sampled twice.
struct PixelVariances {
    int block = 0;
    std::array<GatheredVariances, 2> of;
};

struct PilotSums {
    std::vector<BlockSums> blocks;
    std::vector<PixelVariances> pixels;
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

// Light subpaths per pixel, and the share of the camera samples that meet one.
inline double light_share(const Plan& plan) { return plan.light_quarters / 4.0; }
inline double connection_share(const Plan& plan) { return std::min(1.0, light_share(plan)); }

// Binds the pilot's samples, Candidates::sampled(), to a scene; throws as make_estimator().
Estimator pilot_estimator(const Scene& scene, const CameraDescription& camera,
                          RenderSettings settings);

// Nothing where `control` ended it. `threads` 0: all processors.
std::optional<PilotSums> sample_pilot(const Estimator& estimator, const Grid& grid,
                                      const Candidates& candidates, int threads,
                                      const RenderControl* control);

}  // namespace midway
