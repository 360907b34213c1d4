// Comparisons as `midway compare` could have found them, made up without rendering: for tests of
// the pages that show them.
#pragma once

#include "report/comparison.h"

namespace midway::test {

// Six techniques on a room of 256 x 256 pixels, four seeds, thirty points. Error falls as 1 / time
// with noise; `light` does not cover all, `bdpt:0` is worse than `path` and has bright dots,
// `bdpt:2` is five times as efficient as `path`.
Comparison made_comparison(const std::string& name);

// Three scenes, of which bdpt:2 wins one, loses one, and ties one.
SuiteReport made_suite();

}  // namespace midway::test
