#include "gl_lines.h"

#include <algorithm>
#include <cstddef>

#include "theme.h"
#include "view.h"

namespace midway {
namespace {

// A corner of a line's rectangle; lengths in points.
struct Corner {
    vec2 position;
    vec2 along_across;  // from the line's start, and from its middle
    vec2 half_dash;     // half of the width; length of a dash and its gap, 0: no gaps
    vec4 colour;
};

vec4 colour_of(const PathLine& line) {
    const theme::Color& c = line.kind == LineKind::camera  ? theme::camera
                            : line.kind == LineKind::light ? theme::light
                                                           : theme::rgb(0xffffff);
    const float alpha = line.picked ? (line.hidden ? 0.75f : 1.0f) : (line.hidden ? 0.35f : 0.7f);
    return {c.x, c.y, c.z, alpha};
}

// Far beyond the view a line only costs digits.
std::optional<ImageLine> cut_to(const Rect& r, const ImageLine& line) {
    float from = 0, to = 1;
    const vec2 d = line.b - line.a;
    for (int k = 0; k < 2; ++k) {
        if (d[k] == 0) {
            if (line.a[k] < r.lower[k] || line.a[k] > r.upper[k]) return {};
            continue;
        }
        const float p = (r.lower[k] - line.a[k]) / d[k], q = (r.upper[k] - line.a[k]) / d[k];
        from = std::max(from, std::min(p, q));
        to = std::min(to, std::max(p, q));
    }
    if (!(from < to)) return {};
    return ImageLine{line.a + d * from, line.a + d * to};
}

void add_line(const PathLine& line, const ImageLine& at, float em, std::vector<Corner>& corners) {
    const vec2 d = at.b - at.a;
    const float length = glm::length(d);
    if (!(length > 0.1f)) return;
    const vec2 along = d / length, across(-along.y, along.x);
    const float half = em * (line.picked ? 0.11f : 0.05f);
    // Room for the dark rim and for soft edges.
    const float wide = half + 0.1f * em + 1;
    const float dash = line.hidden ? 0.9f * em : 0;
    const auto corner = [&](bool end, float side) {
        return Corner{(end ? at.b : at.a) + across * (side * wide),
                      {end ? length : 0, side * wide},
                      {half, dash},
                      colour_of(line)};
    };
    const Corner a = corner(false, -1), b = corner(false, 1), c = corner(true, -1),
                 e = corner(true, 1);
    corners.insert(corners.end(), {a, b, c, c, b, e});
}

std::vector<Corner> corners_of(const App& app, float em) {
    const InspectorState& s = app.ui.panel.inspector;
    std::vector<Corner> corners;
    const float margin = 4 * em;
    const Rect room{app.ui.view.lower - margin, app.ui.view.upper + margin};
    // What is hidden first, what is looked at last.
    for (const int turn : {0, 1, 2, 3})
        for (const PathLine& line : s.drawing->lines) {
            if (turn != 2 * line.picked + !line.hidden) continue;
            const auto on_image = place_on_image(*s.camera, s.normalisation, line.a, line.b);
            if (!on_image) continue;
            const auto on_screen = cut_to(
                room, {screen_position(app, on_image->a), screen_position(app, on_image->b)});
            if (on_screen) add_line(line, *on_screen, em, corners);
        }
    return corners;
}

}  // namespace

LinePainter::LinePainter(const Gl& gl)
    : gl_(gl),
      program_(make_program(gl, "path_lines.vert", "path_lines.frag")),
      array_(make_vertex_array(gl)),
      vertices_(make_buffer(gl)) {
    gl.BindVertexArray(*array_);
    gl.BindBuffer(GL_ARRAY_BUFFER, *vertices_);
    const auto field = [&](GLuint index, GLint count, size_t offset) {
        gl.EnableVertexAttribArray(index);
        gl.VertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, sizeof(Corner),
                               reinterpret_cast<const void*>(offset));
    };
    field(0, 2, offsetof(Corner, position));
    field(1, 2, offsetof(Corner, along_across));
    field(2, 2, offsetof(Corner, half_dash));
    field(3, 4, offsetof(Corner, colour));
}

void LinePainter::draw(const App& app, const Display::Target& target) const {
    const InspectorState& s = app.ui.panel.inspector;
    if (!s.drawing || !s.shown || !s.camera) return;
    const std::vector<Corner> corners = corners_of(app, ImGui::GetFontSize());
    if (corners.empty()) return;
    const Rect& view = app.ui.view;
    const auto pixels = [&](float x) { return static_cast<GLint>(std::lround(x * target.scale)); };
    gl_.Viewport(0, 0, target.size.x, target.size.y);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Scissor(pixels(view.lower.x), target.size.y - pixels(view.upper.y),
                std::max(0, pixels(view.size().x)), std::max(0, pixels(view.size().y)));
    gl_.Enable(GL_BLEND);
    gl_.BlendEquation(GL_FUNC_ADD);
    gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const vec2 to_clip = 2 * target.scale / vec2(target.size);
    gl_.UseProgram(*program_);
    gl_.Uniform4f(gl_.GetUniformLocation(*program_, "to_clip"), to_clip.x, -to_clip.y, -1, 1);
    gl_.Uniform1f(gl_.GetUniformLocation(*program_, "pixel"), 1 / target.scale);
    gl_.BindVertexArray(*array_);
    gl_.BindBuffer(GL_ARRAY_BUFFER, *vertices_);
    gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)),
                   corners.data(), GL_STREAM_DRAW);
    gl_.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size()));
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
}

}  // namespace midway
