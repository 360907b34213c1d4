#include "render/recording.h"

namespace midway {

Recording make_recording(const RenderSettings& s) {
    Recording r;
    r.unweighted = s.unweighted;
    if (s.clamp) r.clamp = *s.clamp;
    if (s.only.empty()) return r;
    r.wanted.assign(strategy_count(s.max_bounces + 1), false);
    for (const Strategy& k : s.only)
        if (strategy_index(k) < r.wanted.size()) r.wanted[strategy_index(k)] = true;
    return r;
}

}  // namespace midway
