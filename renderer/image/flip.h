// LDR-FLIP: the difference that a person sees when two images alternate on a screen. P. Andersson,
// J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: a difference
// evaluator for alternating images", HPG 2020; constants and section numbers are that paper's.
//
// 0 is no difference, 1 the largest. Inputs are linear RGB clipped to [0, 1] (NaN to 0) and taken
// as shown on an sRGB display without further tone mapping; nothing is rounded to eight bits.
#pragma once

#include <vector>

#include "image/image.h"

namespace midway {

// A 0.7 m wide monitor of 3840 pixels seen from 0.7 m: 0.7 * 3840 / 0.7 * pi / 180.
inline constexpr double flip_pixels_per_degree = 67.0206432765823;

// One value a pixel, row by row from the top. Both images have one size (not checked).
std::vector<float> flip_map(const Image& test, const Image& reference,
                            double pixels_per_degree = flip_pixels_per_degree);

}  // namespace midway
