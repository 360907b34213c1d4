// Images for snapshots. A window shows a few large images again and again; memory that comes back
// from one snapshot serves the next, whoever lets it go, and no thread pays for its return.
#pragma once

#include <memory>
#include <vector>

#include "render/render_control.h"
#include "render/renderer.h"

namespace midway {

class ImagePool {
  public:
    ImagePool();
    // An image of that size with any content; it may outlive the pool.
    std::shared_ptr<Image> take(int width, int height);
    // Tells of a new job: what the last few have not used is handed out, to be freed.
    std::vector<std::unique_ptr<Image>> unused();

  private:
    struct Shelf;
    std::shared_ptr<Shelf> shelf_;
};

struct ResolvedImages {
    std::vector<std::shared_ptr<const Image>> images, variances;  // one of each per exponent
};

// What is in the renderer's films, resolved on all its threads; empty where `control` is cancelled
// meanwhile. Variances are null with fewer than two passes.
std::optional<ResolvedImages> resolve_all(const ProgressiveRenderer& renderer, size_t exponents,
                                          ImagePool& pool, const RenderControl& control);

}  // namespace midway
