#include "colouring.h"

namespace midway {

Colouring::Colouring(const Gl& gl)
    : gl_(gl),
      program_(make_program(gl, "display.vert", "display.frag")),
      empty_array_(make_vertex_array(gl)) {}

void Colouring::draw(GLuint values, const DisplayMaths& maths, const Other& other) const {
    const auto place = [&](const char* name) { return gl_.GetUniformLocation(*program_, name); };
    gl_.UseProgram(*program_);
    gl_.ActiveTexture(GL_TEXTURE1);
    gl_.BindTexture(GL_TEXTURE_2D, other.values);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, values);
    gl_.Uniform1i(place("values"), 0);
    gl_.Uniform1i(place("other"), 1);
    gl_.Uniform1i(place("mode"), static_cast<int>(maths.mode));
    gl_.Uniform1i(place("curve"), static_cast<int>(maths.curve));
    gl_.Uniform1f(place("scale"), maths.scale);
    gl_.Uniform2f(place("range"), maths.range.x, maths.range.y);
    gl_.Uniform1f(place("relative_floor"), maths.floor);
    gl_.Uniform2f(place("other_lies"), other.lies.x, other.lies.y);
    gl_.Uniform1f(place("pixels"), other.pixels);
    const std::span<const vec3> ramp = stop_ramp(), two_sided = signed_ramp();
    gl_.Uniform3fv(place("ramp"), static_cast<GLsizei>(ramp.size()), &ramp[0].x);
    gl_.Uniform3fv(place("signed_ramp"), static_cast<GLsizei>(two_sided.size()), &two_sided[0].x);
    gl_.BindVertexArray(*empty_array_);
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace midway
