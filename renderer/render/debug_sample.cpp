#include "render/debug_sample.h"

#include "math/float_mode.h"

namespace midway {
namespace {

struct DebugRecord {
    DebugSample& sample;
    bool wants(const Strategy&) const { return true; }
    void contribution(const Contribution& c) {
        sample.contributions.push_back({c, false, sample.x, sample.y});
    }
    void splat(int x, int y, const Contribution& c) {
        sample.contributions.push_back({c, true, x, y});
    }
};

}  // namespace

DebugSample replay_sample(const Estimator& e, int x, int y, std::uint64_t pass) {
    const ScopedFlushToZero flush;
    DebugSample sample{x, y, pass, paired_subpath(e, x, y, pass), {}};
    DebugRecord record{sample};
    LightSubpath scratch;
    RayCounts rays;
    estimate(e, x, y, pass, scratch, record, rays);
    return sample;
}

}  // namespace midway
