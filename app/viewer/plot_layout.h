// Where everything of a log-log plot goes: pure geometry, drawn by plot_drawing.h. Values are
// positive (what is not is left out, and parts the line); positions in points, y downwards.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/state.h"

namespace midway {

struct PlotSeries {
    std::string label;
    size_t color = 0;            // number of its colour, and of its mark
    bool current = false;        // the one that grows now
    std::vector<CurvePoint> of;  // what each value was made from
    std::vector<dvec2> values;   // seconds, error; NaN where unknown
};

struct Plot {
    std::string title;  // "relMSE against cornell.exr"
    std::vector<PlotSeries> series;
    bool is_signed = false;  // values are magnitudes of signed numbers
};

// The curves of one metric; series without any value of it are there, too, and empty.
Plot make_plot(const CompareState& comparison, ErrorMetric metric);

struct PlotTick {
    float at = 0;       // x or y
    std::string label;  // empty: a minor line of the grid
    bool decade = false;
};

struct PlotLine {
    size_t series = 0;
    std::vector<vec2> points;  // a whole run of known values
};

struct PlotLayout {
    Rect area;              // of the data
    dvec2 low{0}, high{0};  // log10 at its left bottom and right top
    std::vector<PlotTick> x, y;
    std::vector<PlotLine> lines;
    std::optional<std::pair<vec2, vec2>> guide;  // of slope -1: the pace of relMSE
};

// `font`: height of the letters. A plot of nothing has its ticks, from 0.1 to 10 seconds.
PlotLayout lay_out(const Plot& plot, const Rect& frame, float font);

vec2 plot_position(const PlotLayout& layout, const dvec2& value);

struct PlotHit {
    size_t series = 0, point = 0;
};
// The point nearest to a place, within a distance.
std::optional<PlotHit> plot_hit(const Plot& plot, const PlotLayout& layout, vec2 at, float within);

// "0.01", "1", "30", "1e-5".
std::string tick_label(double value);

}  // namespace midway
