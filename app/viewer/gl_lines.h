// Draws the lines of the path inspector over the image (shaders/path_lines.*): camera side teal,
// light side amber, the edge that joins them white; what is hidden is dashed and dim.
#pragma once

#include "display.h"

namespace midway {

class LinePainter {
  public:
    explicit LinePainter(const Gl& gl);

    // Into the view of the framebuffer that Display::draw() has drawn.
    void draw(const App& app, const Display::Target& target) const;

  private:
    const Gl& gl_;
    GlHandle program_, array_, vertices_;
};

}  // namespace midway
