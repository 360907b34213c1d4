// The image on the screen. A snapshot is uploaded once, at its own resolution, and turned into
// colours once (shaders/display.frag); a frame of the window then only draws that texture into the
// view. Where A is compared with B, it is a second image of the same kind. Positions are in
// framebuffer pixels.
#pragma once

#include "colouring.h"

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
    // The numbers of an image and their colours.
    struct Layer {
        explicit Layer(const Gl& gl);
        std::shared_ptr<const Image> image;  // uploaded
        GlHandle values, colours, target;
        ivec2 values_size{0}, colours_size{0};
    };
    bool upload(Layer& layer, const std::shared_ptr<const Image>& image);
    void colour(Layer& layer, const ivec2& size, const DisplayMaths& maths);
    void draw_layer(const App& app, const Target& target, const Layer& layer,
                    const ImagePlacement& place, const Rect& part, bool whole_pixels) const;

    const Gl& gl_;
    ShownImage shown_;
    Colouring colouring_;
    GlHandle image_program_, empty_array_;
    Layer b_, a_;
};

// The lower left origin of GL is turned: rows from the top, three bytes a pixel.
std::vector<std::uint8_t> read_pixels(const Gl& gl, const Display::Target& target);

}  // namespace midway
