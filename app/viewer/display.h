// The image on the screen. A snapshot is uploaded once, at its own resolution, and turned into
// colours once (shaders/display.frag); a frame of the window then only draws that texture into the
// view. Positions are in framebuffer pixels.
#pragma once

#include "display_maths.h"
#include "gl.h"

namespace midway {

class Display {
  public:
    explicit Display(const Gl& gl);

    // Uploads and colours what is new; cheap where nothing is.
    void update(const ShownImage& shown);

    struct Target {
        GLuint framebuffer = 0;
        ivec2 size{0};
        float scale = 1;  // framebuffer pixels per point
    };
    // Draws the image into the view; what is left of the target shows `background`.
    void draw(const App& app, const Target& target, const vec3& background) const;

    bool empty() const { return !shown_.image; }

  private:
    void upload(const Image& image);
    void colour();

    const Gl& gl_;
    ShownImage shown_;
    GlHandle colour_program_, image_program_, empty_array_;
    GlHandle values_, colours_, colour_target_;
    ivec2 values_size_{0}, colours_size_{0};
};

// The lower left origin of GL is turned: rows from the top, three bytes a pixel.
std::vector<std::uint8_t> read_pixels(const Gl& gl, const Display::Target& target);

}  // namespace midway
