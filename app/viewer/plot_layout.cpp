#include "plot_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace midway {
namespace {

constexpr dvec2 empty_low{-1, -4}, empty_high{1, 0};
constexpr double least_span = 0.72;  // decades: two of 1, 2, 5, 10 ... are always within
constexpr float left_margin = 3.4f, right_margin = 0.8f, top_margin = 0.6f, bottom_margin = 2.6f;

bool is_shown(const dvec2& v) {
    return v.x > 0 && v.y > 0 && std::isfinite(v.x) && std::isfinite(v.y);
}

// Range of the logarithms along one axis, with a little room at both ends.
void take_range(const Plot& plot, int axis, double& low, double& high) {
    bool any = false;
    for (const PlotSeries& s : plot.series)
        for (const dvec2& v : s.values) {
            if (!is_shown(v)) continue;
            const double l = std::log10(v[axis]);
            low = any ? std::min(low, l) : l;
            high = any ? std::max(high, l) : l;
            any = true;
        }
    if (!any) return;
    const double room = std::max(0.05 * (high - low), (least_span - (high - low)) / 2);
    low -= room;
    high += room;
}

// Decades with a label each, where they have room; 2 and 5 get theirs where decades are few.
std::vector<PlotTick> ticks(double low, double high, float from, float to, float room) {
    std::vector<PlotTick> list;
    const float decade = std::abs(to - from) / static_cast<float>(high - low);
    const int skip = std::max(1, static_cast<int>(std::ceil(room / decade)));
    const bool between = decade * 0.3f > 0.6f * room || high - low < 1.2;
    for (int d = static_cast<int>(std::floor(low)); d <= static_cast<int>(std::floor(high)); ++d)
        for (int i = 1; i < 10; ++i) {
            const double l = d + std::log10(i);
            if (l < low || l > high) continue;
            PlotTick t;
            t.at = from + (to - from) * static_cast<float>((l - low) / (high - low));
            t.decade = i == 1;
            const bool labelled = i == 1 ? d % skip == 0 : between && (i == 2 || i == 5);
            if (labelled) t.label = tick_label(i * std::pow(10.0, d));
            if (i == 1 || decade > 2.5f * room / 3) list.push_back(t);
        }
    return list;
}

// Through the middle of the curve that grows, or of the first.
std::optional<std::pair<vec2, vec2>> guide_of(const Plot& plot, const PlotLayout& l) {
    const PlotSeries* best = nullptr;
    for (const PlotSeries& s : plot.series)
        if (std::any_of(s.values.begin(), s.values.end(), is_shown) && (!best || s.current))
            best = &s;
    if (!best) return {};
    std::vector<dvec2> shown;
    std::copy_if(best->values.begin(), best->values.end(), std::back_inserter(shown), is_shown);
    const dvec2 middle = glm::log(shown[shown.size() / 2]) / std::log(10.0);
    // log y = sum - log x, cut to the area.
    const double sum = middle.x + middle.y;
    const double from = std::max(l.low.x, sum - l.high.y), to = std::min(l.high.x, sum - l.low.y);
    const auto at = [&](double x) {
        return plot_position(l, {std::pow(10.0, x), std::pow(10.0, sum - x)});
    };
    return std::pair{at(from), at(to)};
}

// The same technique always has the same colour; others follow in the order of their appearance.
size_t color_of(const CurveMaker& m, size_t& next) {
    if (m.technique == Technique::path && m.exponent == 2) return 0;
    if (m.technique == Technique::light) return 1;
    if (m.technique == Technique::bdpt && m.exponent == 2) return 2;
    if (m.technique == Technique::bdpt && m.exponent == 1) return 3;
    if (m.technique == Technique::bdpt && m.exponent == 0) return 4;
    return next++;
}

std::string title_of(const CompareState& c, ErrorMetric metric) {
    const std::string file =
        c.reference ? c.reference->path.substr(c.reference->path.find_last_of('/') + 1) : "";
    switch (metric) {
        case ErrorMetric::relmse:
            return "relMSE against " + file;
        case ErrorMetric::trimmed:
            return "relMSE without its worst 0.1 % of pixels, against " + file;
        case ErrorMetric::bias:
            return "difference of the image means, against " + file;
        case ErrorMetric::estimate:
            break;
    }
    return "estimated relMSE, from two halves of the samples";
}

}  // namespace

Plot make_plot(const CompareState& c, ErrorMetric metric) {
    if (!c.reference) metric = ErrorMetric::estimate;
    Plot plot{title_of(c, metric), {}, metric == ErrorMetric::bias};
    size_t next_color = 5;
    for (const LiveCurve& curve : c.curves) {
        PlotSeries s{
            curve.label, color_of(curve.maker, next_color), curve.job == c.live_job, {}, {}};
        // Not a sampler or a seed beside the usual one in the same colour.
        for (const PlotSeries& other : plot.series)
            if (other.color == s.color) s.color = next_color++;
        for (const CurvePoint& p : curve.points) {
            const double v = value_of(p, metric);
            if (std::isnan(v)) continue;
            s.of.push_back(p);
            s.values.emplace_back(p.seconds, plot.is_signed ? std::abs(v) : v);
        }
        plot.series.push_back(std::move(s));
    }
    return plot;
}

std::string tick_label(double v) {
    if (v >= 0.00099 && v < 99999) return fmt::format("{:.4g}", v);
    const int e = static_cast<int>(std::floor(std::log10(v) + 1e-9));
    return fmt::format("{:.0f}e{}", v / std::pow(10.0, e), e);
}

vec2 plot_position(const PlotLayout& l, const dvec2& v) {
    const dvec2 share = (dvec2(std::log10(v.x), std::log10(v.y)) - l.low) / (l.high - l.low);
    const vec2 size = l.area.size();
    return {l.area.lower.x + static_cast<float>(share.x) * size.x,
            l.area.upper.y - static_cast<float>(share.y) * size.y};
}

PlotLayout lay_out(const Plot& plot, const Rect& frame, float font) {
    PlotLayout l;
    l.low = empty_low;
    l.high = empty_high;
    for (int axis = 0; axis < 2; ++axis) take_range(plot, axis, l.low[axis], l.high[axis]);
    l.area = {frame.lower + font * vec2(left_margin, top_margin),
              frame.upper - font * vec2(right_margin, bottom_margin)};
    l.area.upper = glm::max(l.area.upper, l.area.lower + vec2(font));
    l.x = ticks(l.low.x, l.high.x, l.area.lower.x, l.area.upper.x, 3.2f * font);
    l.y = ticks(l.low.y, l.high.y, l.area.upper.y, l.area.lower.y, 1.3f * font);
    for (size_t i = 0; i < plot.series.size(); ++i) {
        bool open = false;
        for (const dvec2& v : plot.series[i].values) {
            if (!is_shown(v)) {
                open = false;
                continue;
            }
            if (!open) l.lines.push_back({i, {}});
            open = true;
            l.lines.back().points.push_back(plot_position(l, v));
        }
    }
    if (!plot.is_signed) l.guide = guide_of(plot, l);
    return l;
}

std::optional<PlotHit> plot_hit(const Plot& plot, const PlotLayout& l, vec2 at, float within) {
    std::optional<PlotHit> hit;
    for (size_t i = 0; i < plot.series.size(); ++i)
        for (size_t k = 0; k < plot.series[i].values.size(); ++k) {
            if (!is_shown(plot.series[i].values[k])) continue;
            const float d = glm::distance(plot_position(l, plot.series[i].values[k]), at);
            if (d > within) continue;
            within = d;
            hit = PlotHit{i, k};
        }
    return hit;
}

}  // namespace midway
