#include "display.h"

#include "view.h"

namespace midway {
namespace {

void filter(const Gl& gl, GLint kind) {
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, kind);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, kind);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

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

Display::Display(const Gl& gl)
    : gl_(gl),
      colour_program_(make_program(gl, "display.vert", "display.frag")),
      image_program_(make_program(gl, "image.vert", "image.frag")),
      empty_array_(make_vertex_array(gl)),
      values_(make_texture(gl)),
      colours_(make_texture(gl)),
      colour_target_(make_framebuffer(gl)) {}

void Display::update(const ShownImage& shown) {
    const bool new_image = shown.image != shown_.image;
    const bool new_colours = new_image || !(shown.maths == shown_.maths);
    shown_ = shown;
    if (!shown_.image) return;
    if (new_image) upload(*shown_.image);
    if (new_colours) colour();
}

void Display::upload(const Image& image) {
    const ivec2 size(image.width, image.height);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.BindTexture(GL_TEXTURE_2D, *values_);
    if (size != values_size_) {
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, size.x, size.y, 0, GL_RGB, GL_FLOAT,
                       image.pixels.data());
        filter(gl_, GL_NEAREST);
        values_size_ = size;
    } else {
        gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, GL_RGB, GL_FLOAT,
                          image.pixels.data());
    }
}

void Display::colour() {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, *colour_target_);
    if (colours_size_ != values_size_) {
        gl_.BindTexture(GL_TEXTURE_2D, *colours_);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, values_size_.x, values_size_.y, 0, GL_RGBA,
                       GL_UNSIGNED_BYTE, nullptr);
        filter(gl_, GL_LINEAR);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *colours_, 0);
        colours_size_ = values_size_;
    }
    const GLuint program = *colour_program_;
    const auto place = [&](const char* name) { return gl_.GetUniformLocation(program, name); };
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
    gl_.Viewport(0, 0, values_size_.x, values_size_.y);
    gl_.UseProgram(program);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, *values_);
    gl_.Uniform1i(place("values"), 0);
    gl_.Uniform1i(place("mode"), static_cast<int>(shown_.maths.mode));
    gl_.Uniform1i(place("curve"), static_cast<int>(shown_.maths.curve));
    gl_.Uniform1f(place("scale"), shown_.maths.scale);
    gl_.Uniform2f(place("range"), shown_.maths.range.x, shown_.maths.range.y);
    const std::span<const vec3> ramp = stop_ramp();
    gl_.Uniform3fv(place("ramp"), static_cast<GLsizei>(ramp.size()), &ramp[0].x);
    gl_.BindVertexArray(*empty_array_);
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
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
    const ImagePlacement& p = shown_.placement;
    const Rect place{screen_position(app, {p.x0, p.y0}), screen_position(app, {p.x1, p.y1})};
    const Rect crop{screen_position(app, vec2(shown_.crop.x0, shown_.crop.y0)),
                    screen_position(app, vec2(shown_.crop.x1, shown_.crop.y1))};
    gl_.Enable(GL_SCISSOR_TEST);
    scissor(gl_, intersection(app.ui.view, crop), target.scale, target.size);

    // Whole pixels keep their edges when magnified; coarse images blur between theirs.
    const float zoom = zoom_in_use(app) * target.scale;
    const bool crisp = shown_.scale == 1 && zoom >= 1;
    const vec2 to_clip = 2 * target.scale / vec2(target.size);
    gl_.UseProgram(*image_program_);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, *colours_);
    filter(gl_, crisp ? GL_NEAREST : GL_LINEAR);
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
