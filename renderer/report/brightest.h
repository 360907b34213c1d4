// Which sample made a pixel bright? Passes are replayed, and of every sample only what it gave to
// one pixel is looked at: its own samples by all strategies, those of all other pixels by the
// splats of their light subpaths. The answer depends on neither threads nor order: of equals the
// one of the lowest pass, row and column counts.
#pragma once

#include <functional>
#include <optional>

#include "render/render_control.h"
#include "report/inspect.h"

namespace midway {

struct BrightestSearch {
    Inspectable what;
    int x = 0, y = 0;                          // the pixel that is watched
    std::uint64_t first_pass = 0, passes = 1;  // of the image
    size_t exponent = 0;                       // which one's weights count
    int threads = 0;                           // 0: all processors
};

struct BrightSample {
    int x = 0, y = 0;  // whose sample it is
    std::uint64_t pass = 0;
    vec3 value{0};  // what it gave to the pixel, as the film took it
    float luminance = 0;
};

// Among the pixel's own samples alone: quick. Empty where all are black, or `control` ended it.
std::optional<BrightSample> brightest_own_sample(const BrightestSearch& search,
                                                 const RenderControl& control);

// Among all samples of the image. `tick` is called some ten times a second by the calling thread
// with the share that is done and the best so far.
using SearchTick = std::function<void(double done, const std::optional<BrightSample>& best)>;
std::optional<BrightSample> brightest_sample(const BrightestSearch& search,
                                             const RenderControl& control, const SearchTick& tick);

// The pixel most likely to hold a single bright sample: where the two halves of the samples differ
// most, and the pixel stands out from its neighbours as far. Relative to the image's corner. Empty
// where nothing stands out.
std::optional<ivec2> brightest_outlier(const Image& image, const Image& variance);

}  // namespace midway
