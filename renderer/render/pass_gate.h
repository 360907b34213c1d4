// How workers that share a batch of passes agree where it ends, when somebody outside asks for an
// early end: between two passes. Every pass that one of them has begun is done by all, and none
// begins a later one; so no sample is lost. The first pass of a batch is always done.
#pragma once

#include "render/render_control.h"

namespace midway {

class PassGate {
  public:
    // Before any work of pass `pass` (counted from 0 within the batch): false where the batch ended
    // before it. Costs one load while the pass is under way.
    bool enter(std::uint64_t pass, const RenderControl* control) {
        std::uint64_t seen = state_.load(std::memory_order_relaxed);
        for (;;) {
            if (pass < (seen & ~closed)) return true;
            if (seen & closed) return false;
            const bool end = seen > 0 && control && control->batch_ends();
            const std::uint64_t next = end ? seen | closed : pass + 1;
            if (state_.compare_exchange_weak(seen, next, std::memory_order_relaxed)) seen = next;
        }
    }

    // Passes that were done, once all workers are at rest.
    std::uint64_t passes() const { return state_.load(std::memory_order_relaxed) & ~closed; }

  private:
    static constexpr std::uint64_t closed = std::uint64_t{1} << 63;
    std::atomic<std::uint64_t> state_{0};  // passes begun, and whether that is all
};

}  // namespace midway
