// A fixture in the float mode of the renderer's workers (renderer/math/float_mode.h), and the
// random numbers of the statistical tests.
//
//     using CosineWarp = midway::test::WorkerMode;
//     TEST_F(CosineWarp, FollowsItsDensity) { ... }
//
// Seeds are fixed. MIDWAY_TEST_SEED=K shifts all of them: for finding out, before a test is
// committed, whether it holds with other seeds than its own.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "math/float_mode.h"
#include "math/hash.h"
#include "math/vector.h"

namespace midway::test {

class WorkerMode : public testing::Test {
    ScopedFlushToZero flush_;
};

inline std::uint64_t test_seed(std::uint64_t seed) {
    const char* shift = std::getenv("MIDWAY_TEST_SEED");
    return seed + (shift ? 1000003 * std::strtoull(shift, nullptr, 10) : 0);
}

// Uniform numbers in [0, 1 - 2^-24], from a generator that the renderer does not use.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(test_seed(seed)) {}
    float next() { return to_unit_float(static_cast<std::uint32_t>(engine_() >> 32)); }
    vec2 next2() {
        const float x = next();
        return {x, next()};
    }
    vec3 next3() {
        const vec2 xy = next2();
        return {xy, next()};
    }
    // Uniform in [0, n).
    std::uint64_t below(std::uint64_t n) { return engine_() % n; }

  private:
    std::mt19937_64 engine_;
};

}  // namespace midway::test
