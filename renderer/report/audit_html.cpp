#include "report/audit_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace midway {
namespace {

std::string short_number(double x) { return x == 0 ? "0" : fmt::format("{:.1e}", x); }
std::string decades(const Range& r) {
    return r.empty() ? "-" : fmt::format("1e{:+.1f} to 1e{:+.1f}", r.low, r.high);
}

void add_checks(HtmlPage& page, const AuditResult& r, const AuditPage& p) {
    HtmlTable t;
    t.caption = "What must hold, what was measured, and where it failed.";
    t.columns = {"check", "measured", "bar", "at fault"};
    for (size_t i = 0; i < r.checks.size(); ++i) {
        const AuditCheck& c = r.checks[i];
        HtmlCell fault(c.fault);
        if (i < p.replay.size()) fault.detail = p.replay[i];
        t.rows.push_back(
            {c.name, HtmlCell(c.measured, c.passed ? Mark::good : Mark::bad), c.bar, fault});
    }
    page.add_heading("Checks");
    page.add_table(t);
}

void add_weights(HtmlPage& page, const AuditResult& r) {
    HtmlTable t;
    t.caption =
        "Same pdfs: the recursion against the direct product form, both given the densities of the "
        "strategy that drew the path. Own pdfs: every strategy evaluates the densities from its "
        "own "
        "side, in float geometry; what the sum misses one by is bias in the image.";
    t.columns = {"exponent",
                 "recursion - direct, worst",
                 "|sum - 1|, same pdfs, worst",
                 "own pdfs, median",
                 "99.9 %",
                 "worst",
                 "bias implied"};
    for (const WeightAudit& w : r.weights)
        t.rows.push_back({fmt::format("{:g}", w.exponent), short_number(w.recursive.worst()),
                          short_number(w.same_sum.worst()), short_number(w.own_sum.quantile(0.5)),
                          short_number(w.own_sum.quantile(0.999)), short_number(w.own_sum.worst()),
                          fmt::format("{:+.1e} &plusmn; {:.1e}", w.bias, w.bias_error)});
    page.add_heading("Weights");
    page.add_table(t);
}

void add_ranges(HtmlPage& page, const AuditResult& r) {
    HtmlTable t;
    t.caption =
        "Partial sums are vcm and vc of the recursion at every vertex; double holds 1e-308 "
        "to 1e+308. Exponents other than 0, 1 and 2 keep their sums as logarithms.";
    t.columns = {"what", "smallest to largest", "decades to overflow"};
    t.rows.push_back({"density per solid angle", decades(r.pdf_w), "-"});
    t.rows.push_back({"density per area", decades(r.pdf_a), "-"});
    for (const WeightAudit& w : r.weights) {
        const double left = decades_to_overflow(w);
        t.rows.push_back({fmt::format("partial sums, exponent {:g}", w.exponent),
                          decades(w.partial_sums),
                          std::isfinite(left) ? fmt::format("{:.0f}", left) : "logarithms"});
    }
    page.add_heading("Ranges");
    page.add_table(t);
}

void add_samples(HtmlPage& page, const AuditResult& r) {
    const SampleAudit& s = r.samples;
    const RayAudit& y = r.rays;
    page.add_heading("Samples and rays");
    page.add_facts(
        {{"samples", fmt::format("{}", s.samples)},
         {"largest contribution",
          fmt::format("{} times the mean sample (pixel {},{} sample {})", format_number(s.largest),
                      s.largest_place.x, s.largest_place.y, s.largest_place.pass)},
         {"brightest 0.1 % of samples",
          fmt::format("{} % of the image", format_number(100 * s.brightest_share))},
         {"not finite", fmt::format("{}", s.nonfinite)},
         {"clamped", fmt::format("{}", s.clamped)},
         {"outside of the film's range", fmt::format("{}", s.overflow)},
         {"with bits below the film's unit", fmt::format("{}", s.inexact)},
         {"rays traced back", fmt::format("{}", y.rays)},
         {"self-hits", fmt::format("{}", y.self_hits.count)},
         {"rays that left closed meshes",
          fmt::format("{}, {} leaks past an edge (at most {} error bounds from it), {} elsewhere",
                      y.closed_rays, y.leaks.count, format_number(y.farthest_leak),
                      y.unexplained.count)},
         {"edges of walks that a connection finds blocked",
          fmt::format("{} of {}", y.blocked.count, y.edges)},
         {"connections that differ when traced backwards",
          fmt::format("{} of {}", y.unequal.count, y.pairs)},
         {"walks ended because rounding left no edge", fmt::format("{}", y.stopped)}});
}

ChartSeries error_series(const FloatRecursion& r, size_t exponent, bool in_float) {
    ChartSeries series;
    series.name =
        fmt::format("exponent {:g}, {}", r.exponents[exponent], in_float ? "float" : "double");
    series.columns = {{"range", {}}, {"worst", {}}, {"tail", {}}, {"median", {}}};
    for (int c = 0; c < float_range_cells; ++c) {
        const FloatRecursionCell& cell = r.at(exponent, c);
        const Deviation& d = in_float ? cell.in_float : cell.in_double;
        if (d.count() == 0) continue;
        // A weight lies between 0 and 1; one that is not a number is as wrong as can be.
        const auto shown = [](double x) { return std::clamp(x, 1e-18, 1.0); };
        series.columns[0].value.push_back((c + 0.5) * float_range_step);
        series.columns[1].value.push_back(shown(d.worst()));
        series.columns[2].value.push_back(shown(d.quantile(0.999)));
        series.columns[3].value.push_back(shown(d.quantile(0.5)));
    }
    return series;
}

void add_float_chart(HtmlPage& page, const FloatRecursion& r) {
    HtmlChart chart;
    chart.title = "Weight error against the range of densities";
    chart.caption =
        "Range: decades between the largest and the smallest density per area of a path's "
        "vertices, "
        "from both ends. Error: worst difference of a path's weights from the direct form in long "
        "double; 1 stands for a weight that is not a number.";
    chart.x = {{"range", "range of the path's densities, decades", false}};
    const std::vector<ChartLevel> levels = {{"1e-9, the bar", 1e-9}, {"1e-3, spoilt", 1e-3}};
    chart.y = {{"worst", "weight error, worst", true, levels},
               {"tail", "weight error, 99.9 %", true, levels},
               {"median", "weight error, median", true, levels}};
    for (size_t b = 0; b < r.exponents.size(); ++b) {
        if (r.exponents[b] == 0.1 || r.exponents[b] == 0.5 || r.exponents[b] == 8) continue;
        for (const bool in_float : {true, false}) {
            ChartSeries s = error_series(r, b, in_float);
            if (!s.columns[0].value.empty()) chart.series.push_back(std::move(s));
        }
    }
    if (!chart.series.empty()) page.add_chart(chart);
}

}  // namespace

FloatSummary summary(const FloatRecursion& r, size_t exponent) {
    FloatSummary s;
    for (int c = 0; c < float_range_cells; ++c) {
        const FloatRecursionCell& cell = r.at(exponent, c);
        s.paths += cell.in_float.count();
        s.spoilt += cell.spoilt;
        s.lost += cell.lost;
        s.worst_double = std::max(s.worst_double, cell.in_double.worst());
    }
    return s;
}

void add_float_recursion(HtmlPage& page, const FloatRecursion& r) {
    HtmlTable t;
    t.caption =
        "The same recursion with every number a float, given the same densities. Spoilt: a weight "
        "is off by more than 1e-3; lost: it is not a number. This renderer keeps its sums in "
        "double.";
    t.columns = {"exponent", "paths", "spoilt in float", "of these lost", "worst in double"};
    for (size_t b = 0; b < r.exponents.size(); ++b) {
        const FloatSummary s = summary(r, b);
        if (s.paths == 0) continue;
        t.rows.push_back({fmt::format("{:g}", r.exponents[b]), fmt::format("{}", s.paths),
                          fmt::format("{} ({} %)", s.spoilt,
                                      format_number(100.0 * double(s.spoilt) / double(s.paths))),
                          fmt::format("{}", s.lost), short_number(s.worst_double)});
    }
    if (t.rows.empty()) return;
    page.add_table(t);
    add_float_chart(page, r);

    HtmlTable by_range;
    by_range.caption = "Exponent 2, by the range of the path's densities.";
    by_range.columns = {"decades", "paths", "float: median", "99.9 %",
                        "worst",   "lost",  "double: worst"};
    const auto power = std::ranges::find(r.exponents, 2.0);
    if (power == r.exponents.end()) return;
    for (int c = 0; c < float_range_cells; ++c) {
        const FloatRecursionCell& cell = r.at(static_cast<size_t>(power - r.exponents.begin()), c);
        if (cell.in_float.count() == 0) continue;
        by_range.rows.push_back(
            {fmt::format("{} to {}", c * float_range_step, (c + 1) * float_range_step),
             fmt::format("{}", cell.in_float.count()), short_number(cell.in_float.quantile(0.5)),
             short_number(cell.in_float.quantile(0.999)), short_number(cell.in_float.worst()),
             fmt::format("{}", cell.lost), short_number(cell.in_double.worst())});
    }
    page.add_table(by_range);
}

std::string audit_html(const AuditResult& r, const AuditPage& p) {
    const auto failed = std::ranges::count(r.checks, false, &AuditCheck::passed);
    HtmlPage page("Numerical audit of " + p.scene,
                  failed == 0 ? fmt::format("All {} checks passed on {} paths of up to {} edges.",
                                            r.checks.size(), r.paths, r.longest_path)
                              : fmt::format("{} of {} checks failed.", failed, r.checks.size()),
                  failed == 0 ? Mark::good : Mark::bad);
    page.add_code(p.command);
    add_checks(page, r, p);
    add_weights(page, r);
    add_ranges(page, r);
    add_samples(page, r);
    page.add_heading("Float beside double");
    add_float_recursion(page, r.float_recursion);

    HtmlTable drawn;
    drawn.caption = "How many paths each strategy drew.";
    drawn.columns = {"strategy", "edges", "paths"};
    for (const AuditResult::Drawn& d : r.strategies)
        drawn.rows.push_back({describe(d.strategy), fmt::format("{}", d.strategy.edges()),
                              fmt::format("{}", d.paths)});
    page.add_heading("Strategies");
    page.begin_details("Paths by strategy");
    page.add_table(drawn);
    page.end_details();
    return page.finish();
}

}  // namespace midway
