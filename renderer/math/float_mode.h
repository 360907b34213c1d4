// Flush-to-zero and denormals-are-zero for the current thread. Workers, replay and tests all run in
// this mode: Embree asks for it, and the bits of an image would otherwise depend on who computes.
#pragma once

#include <immintrin.h>

namespace midway {

class ScopedFlushToZero {
  public:
    ScopedFlushToZero() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
    ~ScopedFlushToZero() { _mm_setcsr(saved_); }
    ScopedFlushToZero(const ScopedFlushToZero&) = delete;
    ScopedFlushToZero& operator=(const ScopedFlushToZero&) = delete;

  private:
    unsigned saved_;
};

}  // namespace midway
