// A job for LiveRender, and the coarse images that stand for it until there is time for more.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "render/settings.h"

namespace midway {

struct LiveJob {
    std::shared_ptr<const Scene> scene;
    CameraDescription camera;
    RenderSettings settings;
    int threads = 0;  // 0: all processors
    std::optional<std::uint64_t> stop_passes;
    std::optional<double> stop_seconds;
    bool statistics = false;  // per strategy
};

int thread_count(const LiveJob& job);

// A rectangle of the whole image, in its pixels. A coarse image may reach a little beyond the crop
// (and the image), by less than one of its pixels: cut it off there.
struct ImagePlacement {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// The same view with scale x scale pixels in one. Scale 1 is the job itself, to the bit.
struct ScaledView {
    CameraDescription camera;
    RenderSettings settings;
    ImagePlacement placement;
};
ScaledView scaled_view(const LiveJob& job, int scale);

// What a pixel sample costs, in thread-seconds; learned from every image, apart for each technique.
class LiveCost {
  public:
    void learn(Technique technique, double thread_seconds, double samples);
    // Smallest scale whose image is expected within `seconds` on so many threads.
    int fitting_scale(const LiveJob& job, int threads, double seconds) const;
    double expected_seconds(const LiveJob& job, int threads, int scale) const;

  private:
    std::array<double, 8> per_sample_{};  // 0: unknown
};

}  // namespace midway
