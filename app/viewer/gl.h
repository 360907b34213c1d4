// OpenGL 3.3 core: a table of the functions that the window uses, loaded from whatever made the
// context (GLFW, EGL or OSMesa), and handles that free what they own. Throws std::runtime_error
// with one line. A table is passed along, so nothing here is global.
#pragma once

#include <GL/glcorearb.h>

#include <string_view>
#include <utility>

namespace midway {

// X(type of the pointer, name without gl)
#define MIDWAY_GL_FUNCTIONS(X)                                   \
    X(PFNGLACTIVETEXTUREPROC, ActiveTexture)                     \
    X(PFNGLATTACHSHADERPROC, AttachShader)                       \
    X(PFNGLBINDBUFFERPROC, BindBuffer)                           \
    X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                 \
    X(PFNGLBINDTEXTUREPROC, BindTexture)                         \
    X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                 \
    X(PFNGLBLENDEQUATIONPROC, BlendEquation)                     \
    X(PFNGLBLENDFUNCSEPARATEPROC, BlendFuncSeparate)             \
    X(PFNGLBUFFERDATAPROC, BufferData)                           \
    X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus)   \
    X(PFNGLCLEARPROC, Clear)                                     \
    X(PFNGLCLEARCOLORPROC, ClearColor)                           \
    X(PFNGLCOMPILESHADERPROC, CompileShader)                     \
    X(PFNGLCREATEPROGRAMPROC, CreateProgram)                     \
    X(PFNGLCREATESHADERPROC, CreateShader)                       \
    X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                     \
    X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)           \
    X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                     \
    X(PFNGLDELETESHADERPROC, DeleteShader)                       \
    X(PFNGLDELETETEXTURESPROC, DeleteTextures)                   \
    X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)           \
    X(PFNGLDISABLEPROC, Disable)                                 \
    X(PFNGLDRAWARRAYSPROC, DrawArrays)                           \
    X(PFNGLDRAWELEMENTSBASEVERTEXPROC, DrawElementsBaseVertex)   \
    X(PFNGLENABLEPROC, Enable)                                   \
    X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray) \
    X(PFNGLFINISHPROC, Finish)                                   \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D)       \
    X(PFNGLGENBUFFERSPROC, GenBuffers)                           \
    X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)                 \
    X(PFNGLGENTEXTURESPROC, GenTextures)                         \
    X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)                 \
    X(PFNGLGETINTEGERVPROC, GetIntegerv)                         \
    X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)             \
    X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                       \
    X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)               \
    X(PFNGLGETSHADERIVPROC, GetShaderiv)                         \
    X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)           \
    X(PFNGLLINKPROGRAMPROC, LinkProgram)                         \
    X(PFNGLPIXELSTOREIPROC, PixelStorei)                         \
    X(PFNGLREADPIXELSPROC, ReadPixels)                           \
    X(PFNGLSCISSORPROC, Scissor)                                 \
    X(PFNGLSHADERSOURCEPROC, ShaderSource)                       \
    X(PFNGLTEXIMAGE2DPROC, TexImage2D)                           \
    X(PFNGLTEXPARAMETERIPROC, TexParameteri)                     \
    X(PFNGLTEXSUBIMAGE2DPROC, TexSubImage2D)                     \
    X(PFNGLUNIFORM1FPROC, Uniform1f)                             \
    X(PFNGLUNIFORM1IPROC, Uniform1i)                             \
    X(PFNGLUNIFORM2FPROC, Uniform2f)                             \
    X(PFNGLUNIFORM3FVPROC, Uniform3fv)                           \
    X(PFNGLUNIFORM4FPROC, Uniform4f)                             \
    X(PFNGLUSEPROGRAMPROC, UseProgram)                           \
    X(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer)         \
    X(PFNGLVIEWPORTPROC, Viewport)

struct Gl {
#define MIDWAY_GL_MEMBER(type, name) type name = nullptr;
    MIDWAY_GL_FUNCTIONS(MIDWAY_GL_MEMBER)
#undef MIDWAY_GL_MEMBER
};

using GlAddress = void (*)();
using GlLookup = GlAddress (*)(const char* name);

// Throws where the current context lacks a function or is older than 3.3.
Gl load_gl(GlLookup lookup);

// A name of the context's that is deleted with it; `gl` and the context must outlive it.
class GlHandle {
  public:
    using Delete = void (*)(const Gl&, GLuint);
    GlHandle() = default;
    GlHandle(const Gl& gl, GLuint name, Delete free) : gl_(&gl), name_(name), free_(free) {}
    ~GlHandle() {
        if (gl_) free_(*gl_, name_);
    }
    GlHandle(GlHandle&& o) noexcept { swap(o); }
    GlHandle& operator=(GlHandle&& o) noexcept {
        swap(o);
        return *this;
    }
    GLuint operator*() const { return name_; }

  private:
    void swap(GlHandle& o) {
        std::swap(gl_, o.gl_);
        std::swap(name_, o.name_);
        std::swap(free_, o.free_);
    }
    const Gl* gl_ = nullptr;
    GLuint name_ = 0;
    Delete free_ = nullptr;
};

GlHandle make_texture(const Gl& gl);
// Of the texture that is bound: GL_NEAREST or GL_LINEAR between its texels, the last one beyond.
void set_filter(const Gl& gl, GLint kind);
GlHandle make_buffer(const Gl& gl);
GlHandle make_vertex_array(const Gl& gl);
GlHandle make_framebuffer(const Gl& gl);

// From the names of files in shaders/; throws with the compiler's first line.
GlHandle make_program(const Gl& gl, std::string_view vertex, std::string_view fragment);

// The text of a file of shaders/, built into the program (app/viewer/CMakeLists.txt).
std::string_view shader_text(std::string_view name);

}  // namespace midway
