// Numbers into colours on the graphics card: shaders/display.frag over a texture of floats.
#pragma once

#include "display_maths.h"
#include "gl.h"

namespace midway {

class Colouring {
  public:
    explicit Colouring(const Gl& gl);

    // The image A that `values` are compared with, in a difference.
    struct Other {
        GLuint values = 0;
        vec2 lies{0};      // from the first corner of the values, in pixels
        float pixels = 1;  // of A along one of the values
    };

    // Into the framebuffer that is bound, pixel by pixel; scissor and viewport are the caller's.
    void draw(GLuint values, const DisplayMaths& maths, const Other& other) const;

  private:
    const Gl& gl_;
    GlHandle program_, empty_array_;
};

}  // namespace midway
