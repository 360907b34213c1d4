// The two tiers of tests/run: the quick one, and the full one (MIDWAY_FULL=1), where the same tests
// take more samples or more cases: `const int paths = by_tier(1000, 100000);`
#pragma once

#include <cstdlib>
#include <string_view>

namespace midway::test {

inline bool full_tier() {
    const char* value = std::getenv("MIDWAY_FULL");
    return value && std::string_view(value) == "1";
}

template <class T>
T by_tier(T quick, T full) {
    return full_tier() ? full : quick;
}

}  // namespace midway::test
