#include "gl.h"

#include <stdexcept>
#include <string>

#include "image/file.h"

namespace midway {
namespace {

[[noreturn]] void refuse_shader(std::string_view name, const std::string& log) {
    throw std::runtime_error("shader does not compile (shaders/" + std::string(name) + ": " +
                             one_line(log.substr(0, log.find('\n'))) +
                             "); update the graphics driver");
}

GLuint compile(const Gl& gl, GLenum kind, std::string_view name) {
    const std::string text(shader_text(name));
    const char* lines = text.c_str();
    const GLuint shader = gl.CreateShader(kind);
    gl.ShaderSource(shader, 1, &lines, nullptr);
    gl.CompileShader(shader);
    GLint good = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        std::string log(1024, '\0');
        gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
        gl.DeleteShader(shader);
        refuse_shader(name, log.c_str());
    }
    return shader;
}

}  // namespace

Gl load_gl(GlLookup lookup) {
    Gl gl;
    const char* missing = nullptr;
#define MIDWAY_GL_LOAD(type, name)                        \
    gl.name = reinterpret_cast<type>(lookup("gl" #name)); \
    if (!gl.name && !missing) missing = "gl" #name;
    MIDWAY_GL_FUNCTIONS(MIDWAY_GL_LOAD)
#undef MIDWAY_GL_LOAD
    if (missing)
        throw std::runtime_error(std::string("OpenGL lacks a function (") + missing +
                                 "); OpenGL 3.3 is needed");
    GLint major = 0, minor = 0;
    gl.GetIntegerv(GL_MAJOR_VERSION, &major);
    gl.GetIntegerv(GL_MINOR_VERSION, &minor);
    if (major * 10 + minor < 33)
        throw std::runtime_error("OpenGL is too old (" + std::to_string(major) + "." +
                                 std::to_string(minor) + "); OpenGL 3.3 is needed");
    return gl;
}

GlHandle make_texture(const Gl& gl) {
    GLuint name = 0;
    gl.GenTextures(1, &name);
    return {gl, name, [](const Gl& g, GLuint n) { g.DeleteTextures(1, &n); }};
}

void set_filter(const Gl& gl, GLint kind) {
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, kind);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, kind);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GlHandle make_buffer(const Gl& gl) {
    GLuint name = 0;
    gl.GenBuffers(1, &name);
    return {gl, name, [](const Gl& g, GLuint n) { g.DeleteBuffers(1, &n); }};
}

GlHandle make_vertex_array(const Gl& gl) {
    GLuint name = 0;
    gl.GenVertexArrays(1, &name);
    return {gl, name, [](const Gl& g, GLuint n) { g.DeleteVertexArrays(1, &n); }};
}

GlHandle make_framebuffer(const Gl& gl) {
    GLuint name = 0;
    gl.GenFramebuffers(1, &name);
    return {gl, name, [](const Gl& g, GLuint n) { g.DeleteFramebuffers(1, &n); }};
}

GlHandle make_program(const Gl& gl, std::string_view vertex, std::string_view fragment) {
    const GLuint shaders[] = {compile(gl, GL_VERTEX_SHADER, vertex),
                              compile(gl, GL_FRAGMENT_SHADER, fragment)};
    GlHandle program(gl, gl.CreateProgram(), [](const Gl& g, GLuint n) { g.DeleteProgram(n); });
    for (const GLuint shader : shaders) {
        gl.AttachShader(*program, shader);
        gl.DeleteShader(shader);
    }
    gl.LinkProgram(*program);
    GLint good = 0;
    gl.GetProgramiv(*program, GL_LINK_STATUS, &good);
    if (!good) {
        std::string log(1024, '\0');
        gl.GetProgramInfoLog(*program, static_cast<GLsizei>(log.size()), nullptr, log.data());
        refuse_shader(fragment, log.c_str());
    }
    return program;
}

}  // namespace midway
