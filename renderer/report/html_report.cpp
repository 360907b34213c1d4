#include "report/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "image/file.h"
#include "report/error_log.h"
#include "report/html_images.h"

namespace midway {
namespace {

std::string interval_text(const Interval& i, int digits = 3) {
    if (!std::isfinite(i.lower) || !std::isfinite(i.upper)) return {};
    return format_number(i.lower, digits) + " to " + format_number(i.upper, digits);
}

HtmlCell interval_cell(const Interval& i, int digits = 3) {
    HtmlCell cell(format_number(i.value, digits));
    cell.detail = interval_text(i, digits);
    return cell;
}

std::string csv_text(const Comparison& c) {
    std::string text = error_csv_header();
    for (const TechniqueResult& t : c.techniques)
        for (const ErrorCurve& curve : t.curves)
            for (const ErrorPoint& point : curve.points)
                text += error_csv_row(t.name, t.exponent, curve.seed, point);
    return text;
}

HtmlCell technique_cell(const TechniqueResult& t) {
    HtmlCell cell(t.label);
    cell.swatch = true;
    if (!t.not_covered.empty()) cell.detail = "does not cover all of this scene";
    return cell;
}

HtmlCell time_cell(const TechniqueResult& t, double relmse) {
    const auto found = std::ranges::find(t.time_to, relmse, &TimeTo::relmse);
    if (found == t.time_to.end()) return "-";
    if (!found->seconds) return t.band.empty() ? "-" : "> " + format_number(t.band.back().seconds);
    return (found->at_most ? "<= " : "") + format_number(*found->seconds);
}

void add_efficiency_table(HtmlPage& page, const Comparison& c) {
    HtmlTable table;
    const std::string first = c.techniques.empty() ? "" : c.techniques[0].label;
    table.caption =
        "Efficiency is 1 / (relMSE x seconds), here relative to " + first +
        ": 2 means half the error in the same time, or the same error in half the time where error "
        "falls as 1 / time. Under each number is its 95 % interval. A tick or a cross stands where "
        "the whole interval lies above or below 1. \"> N\" seconds: not reached after N.";
    table.columns = {"technique", "efficiency", "trimmed", "slope against seconds",
                     "slope against samples"};
    std::vector<double> levels;
    for (const TechniqueResult& t : c.techniques)
        for (const TimeTo& to : t.time_to)
            if (std::ranges::find(levels, to.relmse) == levels.end()) levels.push_back(to.relmse);
    std::ranges::sort(levels, std::greater<>());
    for (double level : levels)
        table.columns.push_back("seconds to relMSE " + format_number(level));
    for (size_t i = 0; i < c.techniques.size(); ++i) {
        const TechniqueResult& t = c.techniques[i];
        const HtmlCell one(i == 0 ? "1" : "-");
        table.rows.push_back({technique_cell(t), i == 0 ? one : efficiency_cell(t.efficiency, t),
                              i == 0 ? one : efficiency_cell(t.efficiency_trimmed, t),
                              interval_cell(t.fit.slope), interval_cell(t.fit.slope_spp)});
        for (double level : levels) table.rows.back().push_back(time_cell(t, level));
    }
    page.add_table(table);
    page.add_paragraph(
        "\"Trimmed\" leaves out the largest 0.1 % of the pixels, which tells how much of the error "
        "a few bright dots make. A slope of -1 is what independent samples of finite variance "
        "give: four times the time, a quarter of the error.");
}

void add_error_table(HtmlPage& page, const Comparison& c) {
    HtmlTable table;
    table.caption = "Errors at the end of the curves, mean over the seeds.";
    table.columns = {"technique", "seconds", "CPU seconds",    "spp", "MSE", "RMSE",
                     "relMSE",    "SMAPE",   "trimmed relMSE", "FLIP"};
    for (const TechniqueResult& t : c.techniques) {
        const ErrorPoint& e = t.final_mean;
        table.rows.push_back({technique_cell(t), format_number(e.seconds),
                              format_number(e.cpu_seconds), std::to_string(e.spp),
                              format_number(e.mse), format_number(e.rmse), format_number(e.relmse),
                              format_number(e.smape), format_number(e.relmse_trimmed),
                              e.flip ? format_number(*e.flip) : "-"});
    }
    page.add_table(table);
}

void add_bias_table(HtmlPage& page, const Comparison& c) {
    HtmlTable table;
    table.caption =
        "Bias is the relative difference between the mean of the technique's images and that of "
        "the reference; z is the same in standard errors. A technique that covers the scene and "
        "passes the limit is wrong, whatever its error.";
    table.columns = {"technique", "bias (%)", "z", "limit of |z|", "verdict"};
    for (const TechniqueResult& t : c.techniques) {
        const BiasVerdict& b = t.bias;
        const Interval percent{b.bias.value * 100, b.bias.lower * 100, b.bias.upper * 100};
        const Mark mark = b.flagged                 ? Mark::bad
                          : !std::isfinite(b.z)     ? Mark::none
                          : std::abs(b.z) > b.limit ? Mark::warning
                                                    : Mark::good;
        table.rows.push_back({technique_cell(t), interval_cell(percent, 2), format_number(b.z, 2),
                              format_number(b.limit, 2), HtmlCell(b.text, mark)});
    }
    page.add_table(table);
}

void add_images(HtmlPage& page, const Comparison& c) {
    const ReferenceInfo& r = c.reference;
    std::string about = r.technique.empty() ? r.source : r.technique;
    if (r.spp > 0) about += fmt::format(", {} spp", r.spp);
    std::vector<PageImage> images{{"reference", about, &r.image}};
    for (const TechniqueResult& t : c.techniques)
        images.push_back(
            {t.label,
             fmt::format("{} spp in {} s, relMSE {}", t.image_spp, format_number(t.image_seconds),
                         format_number(t.final_mean.relmse)),
             &t.image});
    page.add_heading("Images");
    page.add_paragraph(
        "The last image of each technique's first seed. Choose two; what moves or zooms one moves "
        "or zooms both.");
    const auto best = std::ranges::find(images, verdict_of(c).best, &PageImage::name);
    add_image_viewer(page, images,
                     best == images.end() ? images.size() - 1 : size_t(best - images.begin()));
}

void add_gaps(HtmlPage& page, const Comparison& c) {
    page.add_heading("What is not covered, and what was left out");
    bool any = false;
    for (const TechniqueResult& t : c.techniques) {
        if (!t.not_covered.empty()) {
            page.add_paragraph(t.label + " cannot make these paths, so their light is missing:");
            page.add_list(t.not_covered);
        }
        if (!t.left_out.empty()) {
            page.add_paragraph(t.label + " does without:");
            page.add_list(t.left_out);
        }
        if (t.nonfinite > 0)
            page.add_note(Mark::bad, fmt::format("{}: {} samples were not finite and are missing "
                                                 "from its images.",
                                                 t.label, t.nonfinite));
        any = any || !t.not_covered.empty() || !t.left_out.empty() || t.nonfinite > 0;
    }
    if (!c.left_out.empty()) {
        page.add_paragraph("Of the scene, this was left out:");
        page.add_list(c.left_out);
    } else if (!any) {
        page.add_paragraph(
            "Nothing: every technique covers every path of this scene, and nothing of the scene "
            "was left out.");
    }
}

void add_measurement(HtmlPage& page, const Comparison& c) {
    page.add_heading("How this was measured");
    if (!c.method.empty()) page.add_paragraph(c.method);
    page.add_code(c.formula);
    const ReferenceInfo& r = c.reference;
    const auto known = [](bool yes, const std::string& text) { return yes ? text : "unknown"; };
    page.add_facts({{"Reference", r.technique.empty() ? r.source : r.source + " by " + r.technique},
                    {"Its samples per pixel", known(r.spp > 0, std::to_string(r.spp))},
                    {"Its render time", known(r.seconds > 0, format_number(r.seconds) + " s")},
                    {"Why this one", known(!r.why.empty(), r.why)},
                    {"Its own relMSE (the floor)",
                     known(std::isfinite(r.floor_relmse), format_number(r.floor_relmse))},
                    {"Its own MSE", known(std::isfinite(r.floor_mse), format_number(r.floor_mse))},
                    {"Time asked for", format_number(c.time) + " s for each technique and seed"},
                    {"Seeds", std::to_string(c.seeds)},
                    {"Spent on measuring, in no curve", format_number(c.metric_seconds) + " s"}});
}

void add_provenance(HtmlPage& page, const Comparison& c) {
    page.add_heading("Settings");
    std::vector<std::pair<std::string, std::string>> facts{{"Scene", c.scene}};
    for (const NamedValue& s : c.settings) facts.emplace_back(s.name, s.value);
    page.add_facts(facts);
    page.add_heading("Machine");
    page.add_facts({{"Processor", c.machine.cpu},
                    {"Threads", std::to_string(c.machine.threads)},
                    {"Midway", c.machine.version},
                    {"Instruction set", c.machine.instruction_set},
                    {"Compiler", c.machine.compiler}});
    page.add_heading("To make it again");
    page.add_code(c.command);
}

}  // namespace

HtmlCell efficiency_cell(const std::optional<Interval>& efficiency, const TechniqueResult& of) {
    if (!efficiency || !std::isfinite(efficiency->value)) return "-";
    HtmlCell cell = interval_cell(*efficiency);
    if (!of.not_covered.empty()) return cell;
    if (efficiency->lower > 1) cell.mark = Mark::good;
    if (efficiency->upper < 1) cell.mark = Mark::bad;
    return cell;
}

void write_report(const Comparison& c, const std::string& directory) {
    const Verdict verdict = verdict_of(c);
    HtmlPage page(c.name + ": error against run time", verdict.text, verdict.mark);
    for (const std::string& warning : c.warnings) page.add_note(Mark::warning, warning);
    page.add_heading("Error against run time");
    page.add_chart(convergence_chart(c));
    page.add_heading("Which is best, and by how much");
    add_efficiency_table(page, c);
    add_images(page, c);
    page.add_heading("Errors at the end");
    add_error_table(page, c);
    page.add_heading("Is any of them wrong?");
    add_bias_table(page, c);
    add_gaps(page, c);
    add_measurement(page, c);
    add_provenance(page, c);
    page.add_heading("Data");
    page.add_paragraph(
        "Every point of every seed, as in convergence.csv beside this page; summary.json holds "
        "the figures of the tables.");
    page.add_download("convergence.csv", csv_text(c));
    atomic_write((std::filesystem::path(directory) / "report.html").string(), page.finish());
}

}  // namespace midway
