// The chart of a comparison, and what it says in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "report/html_report.h"

namespace midway {
namespace {

using NumberOf = std::function<double(const BandPoint&)>;
using IntervalOf = std::function<const Interval&(const BandPoint&)>;

struct XChoice {
    ChartAxis axis;
    NumberOf number;
};

struct YChoice {
    ChartAxis axis;
    IntervalOf interval;
};

std::vector<XChoice> x_choices() {
    return {
        {{"seconds", "render time (s)"}, [](const BandPoint& p) { return p.seconds; }},
        {{"cpu_seconds", "processor time (s)"}, [](const BandPoint& p) { return p.cpu_seconds; }},
        {{.key = "spp",
          .label = "samples per pixel",
          .note = "Against samples, a curve says how good the samples are, not what they "
                  "cost."},
         [](const BandPoint& p) { return p.spp; }}};
}

std::vector<ChartLevel> floor_levels(double floor) {
    if (!(floor > 0)) return {};
    return {{"the reference's own error: below it a curve means nothing", floor,
             ChartLevel::Shade::below},
            {"ten times that: from here down, curves mean little", 10 * floor}};
}

std::vector<YChoice> y_choices(const Comparison& c) {
    const std::string band =
        c.seeds > 1
            ? fmt::format("Lines are means over {} seeds, bands their 95 % intervals.", c.seeds)
            : "One seed: there is no band.";
    const std::vector<ChartLevel> relmse = floor_levels(c.reference.floor_relmse);
    const std::vector<ChartLevel> mse = floor_levels(c.reference.floor_mse);
    return {
        {{"relmse", "relMSE", true, relmse, band},
         [](const BandPoint& p) -> const Interval& { return p.relmse; }},
        {{"relmse_trimmed", "trimmed relMSE", true, floor_levels(c.reference.floor_relmse_trimmed),
          "Without the worst 0.1 % of the pixels. " + band},
         [](const BandPoint& p) -> const Interval& { return p.relmse_trimmed; }},
        {{"mse", "MSE", true, mse, band},
         [](const BandPoint& p) -> const Interval& { return p.mse; }},
        {{"smape", "SMAPE", true, {}, "Of the reference's noise, nothing is subtracted. " + band},
         [](const BandPoint& p) -> const Interval& { return p.smape; }}};
}

bool any_point(const Comparison& c, const std::function<bool(const BandPoint&)>& known) {
    return std::ranges::any_of(
        c.techniques, [&](const TechniqueResult& t) { return std::ranges::any_of(t.band, known); });
}

ChartSeries series_of(const TechniqueResult& t, const std::vector<XChoice>& xs,
                      const std::vector<YChoice>& ys) {
    ChartSeries series{t.label, {}};
    if (!t.not_covered.empty()) series.note = "does not cover all of this scene";
    for (const XChoice& x : xs) {
        ChartColumn column{x.axis.key, {}};
        for (const BandPoint& p : t.band) column.value.push_back(x.number(p));
        series.columns.push_back(column);
    }
    for (const YChoice& y : ys) {
        ChartColumn column{y.axis.key, {}};
        for (const BandPoint& p : t.band) {
            column.value.push_back(y.interval(p).value);
            column.low.push_back(y.interval(p).lower);
            column.high.push_back(y.interval(p).upper);
        }
        series.columns.push_back(column);
    }
    return series;
}

bool is_candidate(const TechniqueResult& t) {
    return !t.bias.flagged && t.not_covered.empty() && t.efficiency &&
           std::isfinite(t.efficiency->value);
}

std::string range_text(const Interval& i) {
    return std::isfinite(i.lower) && std::isfinite(i.upper)
               ? fmt::format("95 % interval {} to {}", format_number(i.lower, 3),
                             format_number(i.upper, 3))
               : "with one seed there is no interval";
}

// Labels of the candidates whose intervals reach into the best one's.
std::vector<std::string> ties_of(const Comparison& c, const TechniqueResult& best) {
    std::vector<std::string> ties;
    for (const TechniqueResult& t : c.techniques)
        if (&t != &best && is_candidate(t) && t.efficiency->upper >= best.efficiency->lower)
            ties.push_back(t.label);
    return ties;
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (size_t i = 0; i < words.size(); ++i)
        text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
    return text;
}

Verdict ranking(const Comparison& c) {
    const TechniqueResult* best = nullptr;
    for (const TechniqueResult& t : c.techniques)
        if (is_candidate(t) && (!best || t.efficiency->value > best->efficiency->value)) best = &t;
    const std::string first = c.techniques[0].label;
    if (!best)
        return {"No technique that covers this scene could be compared with " + first + ".",
                Mark::warning};
    const Interval& e = *best->efficiency;
    const std::string times =
        format_number(e.value, 3) + " times as efficient as " + first + " (" + range_text(e) + ")";
    if (e.lower > 1) {
        const std::vector<std::string> ties = ties_of(c, *best);
        const std::string tied =
            ties.empty() ? "" : " " + joined(ties) + " cannot be told apart from it.";
        return {best->label + " is " + times + ": less error in the same time." + tied, Mark::good,
                best->label};
    }
    // The first stands for itself only where it covers the scene and is right.
    const TechniqueResult& one = c.techniques[0];
    if (e.upper < 1 && !one.bias.flagged && one.not_covered.empty())
        return {first + " is the best here; the next, " + best->label + ", is only " + times + ".",
                Mark::good, first};
    return {"No technique is shown to be better than " + first + ": the best of the others, " +
                best->label + ", is " + times + ".",
            Mark::warning};
}

}  // namespace

HtmlChart convergence_chart(const Comparison& c) {
    HtmlChart chart;
    chart.title = "Convergence";
    chart.caption =
        "Lower is better. Both axes are logarithmic: error that falls as 1 / time is a straight "
        "line of slope -1. Points at or below zero, which subtracting the reference's own error "
        "can give, cannot be drawn. Point at the curves, or use the arrow keys, to read "
        "values; a click on a name hides its curve.";
    std::vector<XChoice> xs = x_choices();
    std::vector<YChoice> ys = y_choices(c);
    // The first of each stays, so that an empty comparison has a page too.
    const auto unknown_x = [&](const XChoice& x) {
        return x.axis.key != "seconds" &&
               !any_point(c, [&](const BandPoint& p) { return std::isfinite(x.number(p)); });
    };
    const auto unknown_y = [&](const YChoice& y) {
        return y.axis.key != "relmse" && !any_point(c, [&](const BandPoint& p) {
                   return std::isfinite(y.interval(p).value);
               });
    };
    std::erase_if(xs, unknown_x);
    std::erase_if(ys, unknown_y);
    for (const XChoice& x : xs) chart.x.push_back(x.axis);
    for (const YChoice& y : ys) chart.y.push_back(y.axis);
    for (const TechniqueResult& t : c.techniques) chart.series.push_back(series_of(t, xs, ys));
    return chart;
}

Verdict verdict_of(const Comparison& c) {
    if (c.techniques.empty()) return {"Nothing was compared.", Mark::warning};
    Verdict verdict = ranking(c);
    std::vector<std::string> wrong, partial;
    for (const TechniqueResult& t : c.techniques) {
        if (t.bias.flagged) wrong.push_back(t.label);
        if (!t.not_covered.empty()) partial.push_back(t.label);
    }
    if (!partial.empty())
        verdict.text += " " + joined(partial) + (partial.size() == 1 ? " does" : " do") +
                        " not cover all of this scene.";
    if (!wrong.empty()) {
        const std::string& by = c.reference.technique;
        verdict.text = joined(wrong) + (wrong.size() == 1 ? " is" : " are") +
                       " biased, or the reference" +
                       (by.empty() ? "" : ", which " + by + " rendered,") +
                       " is: the mean of the images differs from the reference's by more than "
                       "chance explains. " +
                       verdict.text;
        verdict.mark = Mark::bad;
    }
    if (!c.complete) {
        verdict.text += " The run was stopped early: this is what was measured until then.";
        if (verdict.mark == Mark::good) verdict.mark = Mark::warning;
    }
    return verdict;
}

}  // namespace midway
