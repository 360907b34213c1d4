#include "gl_panels.h"

#include <imgui.h>

#include <cstddef>

namespace midway {
namespace {

// The part of a framebuffer that a command may paint; false where it is empty.
bool clip(const Gl& gl, const ImDrawData& data, const ImVec4& rect, const ivec2& size) {
    const ImVec2 scale = data.FramebufferScale;
    const auto x0 = static_cast<int>(std::max((rect.x - data.DisplayPos.x) * scale.x, 0.0f));
    const auto y0 = static_cast<int>(std::max((rect.y - data.DisplayPos.y) * scale.y, 0.0f));
    const auto x1 = std::min(static_cast<int>((rect.z - data.DisplayPos.x) * scale.x), size.x);
    const auto y1 = std::min(static_cast<int>((rect.w - data.DisplayPos.y) * scale.y), size.y);
    if (x1 <= x0 || y1 <= y0) return false;
    gl.Scissor(x0, size.y - y1, x1 - x0, y1 - y0);
    return true;
}

GLuint texture_of(ImTextureID id) { return static_cast<GLuint>(reinterpret_cast<intptr_t>(id)); }

}  // namespace

PanelPainter::PanelPainter(const Gl& gl)
    : gl_(gl),
      program_(make_program(gl, "panels.vert", "panels.frag")),
      array_(make_vertex_array(gl)),
      vertices_(make_buffer(gl)),
      indices_(make_buffer(gl)),
      atlas_(make_texture(gl)) {
    ImGuiIO& io = ImGui::GetIO();
    io.BackendRendererName = "midway";
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    gl.BindVertexArray(*array_);
    gl.BindBuffer(GL_ARRAY_BUFFER, *vertices_);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, *indices_);
    const auto field = [&](GLuint index, GLint count, GLenum type, GLboolean norm, size_t offset) {
        gl.EnableVertexAttribArray(index);
        gl.VertexAttribPointer(index, count, type, norm, sizeof(ImDrawVert),
                               reinterpret_cast<const void*>(offset));
    };
    field(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
    field(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
    field(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
    upload_fonts();
}

PanelPainter::~PanelPainter() { ImGui::GetIO().Fonts->SetTexID(nullptr); }

void PanelPainter::upload_fonts() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.GetTexDataAsRGBA32(&pixels, &width, &height);
    gl_.BindTexture(GL_TEXTURE_2D, *atlas_);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    fonts.SetTexID(reinterpret_cast<ImTextureID>(static_cast<intptr_t>(*atlas_)));
}

void PanelPainter::draw(const ImDrawData& data, const ivec2& size) const {
    const vec2 scale(2 / data.DisplaySize.x, -2 / data.DisplaySize.y);
    gl_.Viewport(0, 0, size.x, size.y);
    gl_.Enable(GL_BLEND);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.BlendEquation(GL_FUNC_ADD);
    gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_.UseProgram(*program_);
    gl_.Uniform4f(gl_.GetUniformLocation(*program_, "to_clip"), scale.x, scale.y,
                  -1 - data.DisplayPos.x * scale.x, 1 - data.DisplayPos.y * scale.y);
    gl_.Uniform1i(gl_.GetUniformLocation(*program_, "atlas"), 0);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindVertexArray(*array_);
    gl_.BindBuffer(GL_ARRAY_BUFFER, *vertices_);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data,
                       GL_STREAM_DRAW);
        gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                       GL_STREAM_DRAW);
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (!clip(gl_, data, command.ClipRect, size)) continue;
            gl_.BindTexture(GL_TEXTURE_2D, texture_of(command.GetTexID()));
            gl_.DrawElementsBaseVertex(
                GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                reinterpret_cast<const void*>(command.IdxOffset * sizeof(ImDrawIdx)),
                static_cast<GLint>(command.VtxOffset));
        }
    }
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
}

}  // namespace midway
