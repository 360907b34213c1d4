// The thumbnails of the strategy pyramid on the graphics card: one texture, coloured once for every
// snapshot or change of exposure, that the panel cuts its cells from.
#pragma once

#include "colouring.h"

namespace midway {

class PyramidAtlas {
  public:
    explicit PyramidAtlas(const Gl& gl);

    // Uploads and colours what is new and tells the panel where it is; cheap where nothing is.
    void update(App& app);

  private:
    void upload(const Image& image);
    void colour(const App& app, const StrategySnapshot& s);

    const Gl& gl_;
    Colouring colouring_;
    GlHandle values_, colours_, target_;
    ivec2 values_size_{0}, colours_size_{0};
    // What the colours were made from.
    std::shared_ptr<const StrategySnapshot> strategies_;
    DisplayChoices choices_;
};

}  // namespace midway
