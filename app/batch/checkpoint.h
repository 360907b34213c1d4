// Checkpoints of a render: films written now and then, and gone on from.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "render/prepare.h"
#include "render/renderer.h"

namespace midway {

struct CheckpointOptions {
    std::optional<std::string> path;
    double every_seconds = 60;
    bool resume = false;
};

class Checkpoint {
  public:
    Checkpoint(const CheckpointOptions& options, const PreparedScene& prepared,
               const RenderSettings& settings)
        : options_(options), prepared_(prepared), settings_(settings) {}

    // Takes over the film of an earlier run, where there is one. Throws where it is another
    // render's.
    void resume(ProgressiveRenderer& renderer) const;

    void write_if_due(const ProgressiveRenderer& renderer);
    void write(const ProgressiveRenderer& renderer);

  private:
    const CheckpointOptions& options_;
    const PreparedScene& prepared_;
    const RenderSettings& settings_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace midway
