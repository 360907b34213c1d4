// How far an image is from a reference. Sums run in double in the order of the pixels, so the same
// images give the same bits. x is the image under test, r the reference, m the mean luminance of
// the reference (Rec. 709) over the pixels that count.
//
// mse, rmse          mean over pixels and channels of (x - r)^2, and its root
// relmse             mean of (x - r)^2 / (r^2 + 0.01 m^2): does not change with exposure
// relmse_trimmed     the same without the largest 0.1 % of the pixels (rounded down)
// smape              mean of |x - r| / (|x| + |r|), 0 where both are 0
// flip               mean of flip_map (image/flip.h) of the whole images over the pixels that count
// mean_ratio         mean luminance of x over m; 1 where both are 0
//
// A reference that is itself a noisy mean of independent parts adds its own variance v to every
// square. Where v is given, (x - r)^2 - v takes the square's place in mse, relmse and
// relmse_trimmed: its expectation is x's own error, whatever the noise of r (of two halves a, b it
// is the product (x - a)(x - b)). The denominators keep the noise of r, which raises relmse by a
// share of some 3 v / r^2 and by 6 v^2 / r^4: little where v is small. mse and relmse may then fall
// below 0; rmse is 0 there. Pixels are trimmed by the bare square.
//
// A quotient 0 / 0 counts as 0. Throws std::runtime_error with one line "WHAT (WHERE); REMEDY" for
// images that cannot be compared: sizes differ, no pixel counts, or one that counts is not finite.
#pragma once

#include <optional>

#include "image/image.h"

namespace midway {

struct ImageError {
    double mse = 0, rmse = 0, relmse = 0, relmse_trimmed = 0, smape = 0, flip = 0, mean_ratio = 1;
};

struct DiffOptions {
    std::optional<Image> mask;      // pixels that are not black count; all without a mask
    std::optional<double> epsilon;  // relMSE's denominator is r^2 + epsilon
    bool flip = true;               // most of the time goes into it; left at 0 where not wanted
    const Image* reference_variance = nullptr;  // of its pixels, estimated
};

ImageError compare_images(const Image& test, const Image& reference,
                          const DiffOptions& options = {});

// Relative difference of the image means: 0 where the estimate is right on average.
inline double bias(const ImageError& error) { return error.mean_ratio - 1; }

}  // namespace midway
