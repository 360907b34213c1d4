// The optional data folder with public scenes and broken files: $MIDWAY_SHARED, or `shared` beside
// the source tree. Tests that use it skip, and say so, where it is absent:
//
//     MIDWAY_SKIP_WITHOUT_SHARED("scenes/Cameras/Cameras.gltf");
//     const std::filesystem::path file = midway::test::shared_path("scenes/Cameras/Cameras.gltf");
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace midway::test {

inline std::filesystem::path shared_path(const std::string& relative) {
    const char* folder = std::getenv("MIDWAY_SHARED");
    const std::filesystem::path root =
        folder && *folder ? std::filesystem::path(folder)
                          : std::filesystem::path(MIDWAY_SOURCE_DIR) / ".." / "shared";
    return root / relative;
}

inline bool shared_exists(const std::string& relative) {
    std::error_code ignored;
    return std::filesystem::exists(shared_path(relative), ignored);
}

}  // namespace midway::test

// A macro since GTEST_SKIP returns from the test that calls it.
#define MIDWAY_SKIP_WITHOUT_SHARED(relative)                                            \
    if (midway::test::shared_exists(relative)) {                                        \
    } else                                                                              \
        GTEST_SKIP() << "optional data absent: " << midway::test::shared_path(relative) \
                     << " (set MIDWAY_SHARED)"
