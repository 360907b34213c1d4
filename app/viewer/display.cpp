#include "display.h"

#include "view.h"

namespace midway {
namespace {

// A rectangle of the target with the origin at its upper left corner as a scissor.
void scissor(const Gl& gl, const Rect& r, float scale, const ivec2& target) {
    const auto x0 = static_cast<int>(std::lround(r.lower.x * scale));
    const auto y0 = static_cast<int>(std::lround(r.lower.y * scale));
    const auto x1 = static_cast<int>(std::lround(r.upper.x * scale));
    const auto y1 = static_cast<int>(std::lround(r.upper.y * scale));
    gl.Scissor(x0, target.y - y1, std::max(0, x1 - x0), std::max(0, y1 - y0));
}

Rect intersection(const Rect& a, const Rect& b) {
    return {glm::max(a.lower, b.lower), glm::min(a.upper, b.upper)};
}

}  // namespace

Display::Layer::Layer(const Gl& gl)
    : values(make_texture(gl)), colours(make_texture(gl)), target(make_framebuffer(gl)) {}

Display::Display(const Gl& gl)
    : gl_(gl),
      colouring_(gl),
      image_program_(make_program(gl, "image.vert", "image.frag")),
      empty_array_(make_vertex_array(gl)),
      b_(gl),
      a_(gl) {}

void Display::update(const ShownImage& shown) {
    const bool new_maths = !(shown.maths == shown_.maths);
    const bool moved = shown.scale != shown_.scale || shown.placement.x0 != shown_.placement.x0 ||
                       shown.placement.y0 != shown_.placement.y0 ||
                       shown.differs() != shown_.differs();
    const bool compared = shown.other != shown_.other;
    shown_ = shown;
    if (!shown_.image) return;
    const bool new_b = upload(b_, shown_.image), new_a = upload(a_, shown_.other);
    if (shown_.differs()) {
        if (new_b || new_a || new_maths || moved) colour(b_, a_.values_size, shown_.maths);
        return;
    }
    if (new_b || new_maths || moved) colour(b_, b_.values_size, shown_.maths);
    if (shown_.other && (new_a || new_maths || moved || compared))
        colour(a_, a_.values_size, shown_.maths);
}

// True where it is another one than before.
bool Display::upload(Layer& layer, const std::shared_ptr<const Image>& image) {
    if (layer.image == image) return false;
    layer.image = image;
    if (!image) return true;
    const ivec2 size(image->width, image->height);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.BindTexture(GL_TEXTURE_2D, *layer.values);
    if (size != layer.values_size) {
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, size.x, size.y, 0, GL_RGB, GL_FLOAT,
                       image->pixels.data());
        set_filter(gl_, GL_NEAREST);
        layer.values_size = size;
    } else {
        gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, GL_RGB, GL_FLOAT,
                          image->pixels.data());
    }
    return true;
}

void Display::colour(Layer& layer, const ivec2& size, const DisplayMaths& maths) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, *layer.target);
    if (layer.colours_size != size) {
        gl_.BindTexture(GL_TEXTURE_2D, *layer.colours);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.x, size.y, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                       nullptr);
        set_filter(gl_, GL_LINEAR);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                                 *layer.colours, 0);
        layer.colours_size = size;
    }
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
    gl_.Viewport(0, 0, size.x, size.y);
    const vec2 lies(shown_.other_place.x0 - shown_.placement.x0,
                    shown_.other_place.y0 - shown_.placement.y0);
    colouring_.draw(*layer.values, maths, {*a_.values, lies, static_cast<float>(shown_.scale)});
}

void Display::draw(const App& app, const Target& target, const vec3& background) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl_.Viewport(0, 0, target.size.x, target.size.y);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
    gl_.ClearColor(background.x, background.y, background.z, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    if (!shown_.image) return;

    // Show no more than the crop, though coarse pixels reach beyond it.
    const auto on_screen = [&](const PixelRect& r) {
        const Rect place{screen_position(app, vec2(r.x0, r.y0)),
                         screen_position(app, vec2(r.x1, r.y1))};
        return intersection(app.ui.view, place);
    };
    Rect b = on_screen(shown_.crop);
    if (!shown_.other) return draw_layer(app, target, b_, shown_.placement, b, shown_.scale == 1);
    const PixelRect& o = shown_.other_place;
    const ImagePlacement other{double(o.x0), double(o.y0), double(o.x1), double(o.y1)};
    Rect a = on_screen(o);
    if (shown_.differs()) return draw_layer(app, target, b_, other, intersection(a, b), true);
    const float wipe = screen_position(app, {shown_.wipe, 0}).x;
    b.lower.x = std::max(b.lower.x, wipe);
    a.upper.x = std::min(a.upper.x, wipe);
    draw_layer(app, target, b_, shown_.placement, b, shown_.scale == 1);
    draw_layer(app, target, a_, other, a, true);
}

// Whole pixels keep their edges when magnified; coarse images blur between theirs.
void Display::draw_layer(const App& app, const Target& target, const Layer& layer,
                         const ImagePlacement& p, const Rect& part, bool whole_pixels) const {
    const Rect place{screen_position(app, {p.x0, p.y0}), screen_position(app, {p.x1, p.y1})};
    gl_.Enable(GL_SCISSOR_TEST);
    scissor(gl_, part, target.scale, target.size);
    const bool crisp = whole_pixels && zoom_in_use(app) * target.scale >= 1;
    const vec2 to_clip = 2 * target.scale / vec2(target.size);
    gl_.UseProgram(*image_program_);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, *layer.colours);
    set_filter(gl_, crisp ? GL_NEAREST : GL_LINEAR);
    gl_.Uniform1i(gl_.GetUniformLocation(*image_program_, "image"), 0);
    gl_.Uniform4f(gl_.GetUniformLocation(*image_program_, "rectangle"),
                  place.lower.x * to_clip.x - 1, 1 - place.lower.y * to_clip.y,
                  place.upper.x * to_clip.x - 1, 1 - place.upper.y * to_clip.y);
    gl_.BindVertexArray(*empty_array_);
    gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    gl_.Disable(GL_SCISSOR_TEST);
}

std::vector<std::uint8_t> read_pixels(const Gl& gl, const Display::Target& target) {
    const auto row = static_cast<size_t>(target.size.x) * 3;
    std::vector<std::uint8_t> below(row * target.size.y), rows;
    gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadPixels(0, 0, target.size.x, target.size.y, GL_RGB, GL_UNSIGNED_BYTE, below.data());
    rows.reserve(below.size());
    for (int y = target.size.y - 1; y >= 0; --y)
        rows.insert(rows.end(), below.begin() + static_cast<std::ptrdiff_t>(row * y),
                    below.begin() + static_cast<std::ptrdiff_t>(row * (y + 1)));
    return rows;
}

}  // namespace midway
