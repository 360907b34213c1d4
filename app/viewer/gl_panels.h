// Draws what ImGui made of the panels. ImGui's own backend loads OpenGL by itself and knows nothing
// of OSMesa; this one goes through the same table as the rest.
#pragma once

#include "gl.h"
#include "math/vector.h"

struct ImDrawData;

namespace midway {

class PanelPainter {
  public:
    explicit PanelPainter(const Gl& gl);
    ~PanelPainter();
    PanelPainter(const PanelPainter&) = delete;
    PanelPainter& operator=(const PanelPainter&) = delete;

    // After the fonts of ImGui's atlas changed.
    void upload_fonts();

    // Into the framebuffer that is bound, of `size` pixels.
    void draw(const ImDrawData& data, const ivec2& size) const;

  private:
    const Gl& gl_;
    GlHandle program_, array_, vertices_, indices_, atlas_;
};

}  // namespace midway
