#include "plot_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "display.h"
#include "theme.h"
#include "widgets.h"

namespace midway {
namespace {

using ui::em;

// Camera and light sides as everywhere; the others differ in hue and lightness from them and from
// each other. The mark tells curves apart where colours do not.
constexpr std::array<theme::Color, 9> colours = {
    theme::camera,        theme::light,         theme::rgb(0x6fa8ff),
    theme::rgb(0xc48bf5), theme::rgb(0xf27aa5), theme::rgb(0xa6d24f),
    theme::rgb(0xe8e8e8), theme::rgb(0xb98a5e), theme::rgb(0x8f9bb0)};

ImU32 color_of(const PlotSeries& s, float alpha = 1) {
    return theme::color(colours[s.color % colours.size()], alpha);
}

ImVec2 im(vec2 v) { return {v.x, v.y}; }

void draw_mark(ImDrawList& list, vec2 at, size_t kind, float r, ImU32 color) {
    switch (kind % 4) {
        case 0:
            list.AddCircleFilled(im(at), r, color, 12);
            break;
        case 1:
            list.AddRectFilled(im(at - 0.88f * r), im(at + 0.88f * r), color);
            break;
        case 2:
            list.AddTriangleFilled(im(at + r * vec2(0, -1.2f)), im(at + r * vec2(1.1f, 0.8f)),
                                   im(at + r * vec2(-1.1f, 0.8f)), color);
            break;
        default:
            list.AddQuadFilled(im(at + r * vec2(0, -1.25f)), im(at + r * vec2(1.25f, 0)),
                               im(at + r * vec2(0, 1.25f)), im(at + r * vec2(-1.25f, 0)), color);
            break;
    }
}

void draw_grid(ImDrawList& list, const PlotLayout& l) {
    const ImVec2 a = im(l.area.lower), b = im(l.area.upper);
    list.AddRectFilled(a, b, theme::color(theme::rgb(0x191919)));
    const ImU32 minor = theme::color(theme::rgb(0x242424)),
                major = theme::color(theme::rgb(0x393939)), ink = theme::color(theme::text_dim);
    const float gap = em(0.35f);
    for (const bool decades : {false, true}) {
        for (const PlotTick& t : l.x)
            if (t.decade == decades)
                list.AddLine({t.at, a.y}, {t.at, b.y}, decades ? major : minor);
        for (const PlotTick& t : l.y)
            if (t.decade == decades)
                list.AddLine({a.x, t.at}, {b.x, t.at}, decades ? major : minor);
    }
    for (const PlotTick& t : l.x) {
        const ImVec2 size = ImGui::CalcTextSize(t.label.c_str());
        list.AddText({t.at - size.x / 2, b.y + gap * 0.6f}, ink, t.label.c_str());
    }
    for (const PlotTick& t : l.y) {
        const ImVec2 size = ImGui::CalcTextSize(t.label.c_str());
        list.AddText({a.x - gap - size.x, t.at - size.y / 2}, ink, t.label.c_str());
    }
    const char* x_title = "seconds of rendering";
    const float width = ImGui::CalcTextSize(x_title).x;
    list.AddText({(a.x + b.x - width) / 2, b.y + em(1.35f)}, ink, x_title);
}

// Dashes along the guide, and what it is.
void draw_guide(ImDrawList& list, const PlotLayout& l) {
    if (!l.guide) return;
    const auto [from, to] = *l.guide;
    const float length = glm::distance(from, to), dash = em(0.45f);
    if (length < dash) return;
    const ImU32 ink = theme::color(theme::text_dim, 0.8f);
    const vec2 way = (to - from) / length;
    for (float t = 0; t < length; t += 2 * dash)
        list.AddLine(im(from + way * t), im(from + way * std::min(t + dash, length)), ink);
    const char* name = "error x time is constant";
    const ImVec2 size = ImGui::CalcTextSize(name);
    if (l.area.size().x < 2.2f * size.x) return;
    const vec2 at = from + way * (0.97f * length) - vec2(size.x + em(0.6f), size.y * 0.2f);
    list.AddText({std::clamp(at.x, l.area.lower.x + em(0.3f), l.area.upper.x - size.x),
                  std::clamp(at.y, l.area.lower.y, l.area.upper.y - size.y - em(0.2f))},
                 ink, name);
}

void draw_curves(ImDrawList& list, const Plot& plot, const PlotLayout& l) {
    const float r = em(0.2f);
    for (const PlotLine& line : l.lines) {
        const PlotSeries& s = plot.series[line.series];
        const ImU32 color = color_of(s);
        const float width = std::max(1.0f, em(s.current ? 0.14f : 0.1f));
        for (size_t i = 0; i + 1 < line.points.size(); ++i)
            list.AddLine(im(line.points[i]), im(line.points[i + 1]), color, width);
        for (const vec2& p : line.points) draw_mark(list, p, s.color, r, color);
    }
}

// At the right top, where errors that fall leave room.
void draw_legend(ImDrawList& list, const Plot& plot, const PlotLayout& l) {
    if (plot.series.empty()) return;
    const float line = ImGui::GetTextLineHeight() * 1.08f, pad = em(0.4f);
    float width = 0;
    for (const PlotSeries& s : plot.series)
        width = std::max(width, ImGui::CalcTextSize(s.label.c_str()).x);
    const vec2 size(width + 2 * pad + em(1.1f),
                    line * static_cast<float>(plot.series.size()) + pad);
    const vec2 at(l.area.upper.x - size.x - pad, l.area.lower.y + pad);
    list.AddRectFilled(im(at), im(at + size), theme::color(theme::rgb(0x191919), 0.85f), em(0.2f));
    for (size_t i = 0; i < plot.series.size(); ++i)
        draw_legend_entry(list, plot.series[i],
                          at + vec2(pad, pad / 2 + line * static_cast<float>(i)));
}

}  // namespace

void draw_plot(ImDrawList& list, const Plot& plot, const PlotLayout& l,
               const std::optional<PlotHit>& hit, bool legend) {
    draw_grid(list, l);
    list.PushClipRect(im(l.area.lower), im(l.area.upper), true);
    draw_guide(list, l);
    draw_curves(list, plot, l);
    list.PopClipRect();
    if (legend) draw_legend(list, plot, l);
    if (l.lines.empty()) {
        const char* text = "nothing measured yet";
        const ImVec2 size = ImGui::CalcTextSize(text);
        const vec2 middle = 0.5f * (l.area.lower + l.area.upper) - 0.5f * vec2(size.x, size.y);
        list.AddText(im(middle), theme::color(theme::text_dim), text);
    }
    if (!hit) return;
    const PlotSeries& s = plot.series[hit->series];
    const vec2 at = plot_position(l, s.values[hit->point]);
    list.AddLine({at.x, at.y}, {at.x, l.area.upper.y}, color_of(s, 0.5f));
    list.AddLine({l.area.lower.x, at.y}, {at.x, at.y}, color_of(s, 0.5f));
    list.AddCircle(im(at), em(0.4f), theme::color(theme::text), 16, std::max(1.0f, em(0.1f)));
}

bool has_value(const PlotSeries& s) {
    return std::any_of(s.values.begin(), s.values.end(), [](const dvec2& v) { return v.y > 0; });
}

void draw_legend_entry(ImDrawList& list, const PlotSeries& s, vec2 at) {
    const float alpha = has_value(s) ? 1.0f : 0.5f;
    draw_mark(list, at + vec2(em(0.3f), ImGui::GetTextLineHeight() / 2), s.color, em(0.24f),
              color_of(s, alpha));
    list.AddText(im(at + vec2(em(1.1f), 0)),
                 theme::color(s.current ? theme::text : theme::text_dim, alpha), s.label.c_str());
}

std::string describe(const Plot& plot, const PlotHit& hit) {
    const PlotSeries& s = plot.series[hit.series];
    const CurvePoint& p = s.of[hit.point];
    std::string text = fmt::format("{}\n{:.3g} s, {} samples per pixel", s.label, p.seconds, p.spp);
    if (p.measured)
        text += fmt::format("\nrelMSE {:.3g}, trimmed {:.3g}, bias {:+.2g} %", p.measured->relmse,
                            p.measured->relmse_trimmed, 100 * p.measured->bias);
    if (std::isfinite(p.estimate)) text += fmt::format("\nestimated relMSE {:.3g}", p.estimate);
    return text;
}

std::vector<std::uint8_t> paint_plot(const Gl& gl, const PanelPainter& painter, const Plot& plot,
                                     const ivec2& size) {
    const GlHandle texture = make_texture(gl), target = make_framebuffer(gl);
    gl.BindTexture(GL_TEXTURE_2D, *texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.x, size.y, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                  nullptr);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.BindFramebuffer(GL_FRAMEBUFFER, *target);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *texture, 0);

    ImDrawList list(ImGui::GetDrawListSharedData());
    list._ResetForNewFrame();
    list.PushTextureID(ImGui::GetIO().Fonts->TexID);
    list.PushClipRect({0, 0}, {static_cast<float>(size.x), static_cast<float>(size.y)});
    list.AddRectFilled({0, 0}, im(vec2(size)), theme::color(theme::panel));
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {em(1), em(0.6f)},
                 theme::color(theme::text), plot.title.c_str());
    const Rect frame{{em(0.4f), em(1.8f)}, vec2(size) - em(0.4f)};
    draw_plot(list, plot, lay_out(plot, frame, ImGui::GetFontSize()), {}, true);

    ImDrawList* lists[] = {&list};
    ImDrawData data;
    data.Valid = true;
    data.CmdLists = lists;
    data.CmdListsCount = 1;
    data.DisplayPos = {0, 0};
    data.DisplaySize = im(vec2(size));
    data.FramebufferScale = {1, 1};
    painter.draw(data, size);
    return read_pixels(gl, {*target, size, 1});
}

}  // namespace midway
