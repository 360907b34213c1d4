// Draws a log-log plot with ImGui's lines and letters, in the window or into a picture of its own.
#pragma once

#include <imgui.h>

#include "gl.h"
#include "gl_panels.h"
#include "plot_layout.h"

namespace midway {

// `hit`: the point under the mouse, to be marked.
void draw_plot(ImDrawList& list, const Plot& plot, const PlotLayout& layout,
               const std::optional<PlotHit>& hit, bool legend);

// The mark of a curve and its name, grey where nothing of it is known.
void draw_legend_entry(ImDrawList& list, const PlotSeries& series, vec2 at);
bool has_value(const PlotSeries& series);

// What the hover says of a point, in lines.
std::string describe(const Plot& plot, const PlotHit& hit);

// A picture of the plot, rows from the top, three bytes a pixel. Within a frame of ImGui.
std::vector<std::uint8_t> paint_plot(const Gl& gl, const PanelPainter& painter, const Plot& plot,
                                     const ivec2& size);

}  // namespace midway
