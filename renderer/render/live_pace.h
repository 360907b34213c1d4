// How often a render for a window shows what it has.
#pragma once

#include <algorithm>
#include <chrono>

namespace midway {

inline constexpr double first_image_budget = 0.02;  // seconds
// A job whose first image is not out may finish that image while it is younger than this.
inline constexpr auto protected_age = std::chrono::milliseconds(50);

// Seconds from one snapshot to the next: at least and at most so long, in between a share of the
// time so far. Resolving large images takes time from rendering: after the first second, at most
// this share.
inline double interval_after(double elapsed, double resolving) {
    constexpr double shortest_interval = 1.0 / 60, longest_interval = 2, interval_share = 0.05;
    constexpr double first_second = 1, resolving_share = 0.03;
    double interval = interval_share * elapsed;
    if (elapsed > first_second) interval = std::max(interval, resolving / resolving_share);
    return std::clamp(interval, shortest_interval, longest_interval);
}

}  // namespace midway
