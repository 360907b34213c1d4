// index.html of a suite: what was gained and lost on every scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "image/file.h"
#include "report/html_images.h"
#include "report/html_report.h"
#include "report/summary.h"

namespace midway {
namespace {

const TechniqueResult* find(const Comparison& c, const std::string& label) {
    const auto found = std::ranges::find(c.techniques, label, &TechniqueResult::label);
    return found == c.techniques.end() ? nullptr : &*found;
}

// Whether a technique's errors say how well it does: all of the scene is in them.
bool is_sound(const TechniqueResult& t) { return t.not_covered.empty() && !t.bias.flagged; }

HtmlCell result_cell(const Comparison& c, const std::string& label) {
    const TechniqueResult* t = find(c, label);
    if (!t) return "-";
    HtmlCell cell = t == &c.techniques[0] ? HtmlCell("1") : efficiency_cell(t->efficiency, *t);
    const auto remark = [&](const char* text) {
        cell.detail += (cell.detail.empty() ? "" : "\n") + std::string(text);
    };
    if (!t->not_covered.empty()) remark("does not cover all");
    if (t->bias.flagged) {
        remark("BIASED");
        cell.mark = Mark::bad;
    }
    return cell;
}

// How a technique fares against the first, scene by scene.
struct Score {
    std::vector<std::string> better, worse, even;
    std::vector<std::string> uncounted;  // one of the two is not sound there
    double logarithms = 0;               // sum of those of the ratios, uncounted ones left out

    size_t counted() const { return better.size() + worse.size() + even.size(); }
    // Of the ratios' geometric mean.
    double mean_logarithm() const {
        return counted() > 0 ? logarithms / double(counted())
                             : -std::numeric_limits<double>::infinity();
    }
};

Score score_of(const SuiteReport& suite, const std::string& label) {
    Score score;
    for (const Comparison& c : suite.scenes) {
        const TechniqueResult* t = find(c, label);
        if (!t || t == &c.techniques[0] || !t->efficiency || !std::isfinite(t->efficiency->value))
            continue;
        const std::string entry = c.name + " (" + format_number(t->efficiency->value) + ")";
        if (!is_sound(*t) || !is_sound(c.techniques[0])) {
            score.uncounted.push_back(c.name);
            continue;
        }
        score.logarithms += std::log(std::max(t->efficiency->value, 1e-300));
        (t->efficiency->lower > 1   ? score.better
         : t->efficiency->upper < 1 ? score.worse
                                    : score.even)
            .push_back(entry);
    }
    return score;
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
    return text.empty() ? "-" : text;
}

std::string after_colon(const std::vector<std::string>& words) {
    return words.empty() ? "" : ": " + joined(words);
}

void add_scores(HtmlPage& page, const SuiteReport& suite, const std::vector<std::string>& labels) {
    HtmlTable table;
    table.caption = "Against " + labels[0] +
                    ", by scene, with the ratio. Better and worse: the whole 95 % interval lies "
                    "above or below 1. Not counted: one of the two does not cover the scene, or is "
                    "biased.";
    table.columns = {"technique", "better on", "worse on", "not told apart on", "not counted on"};
    for (size_t i = 1; i < labels.size(); ++i) {
        const Score score = score_of(suite, labels[i]);
        HtmlCell name(labels[i]);
        name.swatch = true;
        table.rows.push_back({name, joined(score.better), joined(score.worse), joined(score.even),
                              joined(score.uncounted)});
    }
    page.add_heading("Gains and losses");
    page.add_table(table);
}

void add_scenes(HtmlPage& page, const SuiteReport& suite, const std::vector<std::string>& labels) {
    HtmlTable table;
    table.caption = "Efficiency, 1 / (relMSE x seconds), relative to " + labels[0] +
                    ", with its 95 % interval under it. Above 1 is better than " + labels[0] +
                    ". Every name leads to the scene's report.";
    table.columns = {"scene"};
    table.columns.insert(table.columns.end(), labels.begin(), labels.end());
    table.columns.push_back("in words");
    for (const Comparison& c : suite.scenes) {
        HtmlCell name(c.name);
        name.link = c.name + "/report.html";
        name.image = thumbnail_uri(c.reference.image, 160);
        std::vector<HtmlCell> row{name};
        for (const std::string& label : labels) row.push_back(result_cell(c, label));
        row.push_back(verdict_of(c).text);
        table.rows.push_back(row);
    }
    page.add_heading("All scenes");
    page.add_table(table);
}

// Which technique does best, by the geometric mean of its ratios to the first, among those that can
// be counted on most scenes.
std::string best_on_the_whole(const SuiteReport& suite, const std::vector<std::string>& labels) {
    std::string best;
    Score score;
    for (size_t i = 1; i < labels.size(); ++i) {
        const Score s = score_of(suite, labels[i]);
        const bool better = s.counted() == score.counted()
                                ? s.mean_logarithm() > score.mean_logarithm()
                                : s.counted() > score.counted();
        if (!better) continue;
        best = labels[i];
        score = s;
    }
    if (best.empty()) return "";
    const std::string against =
        fmt::format("gainst {} it is better on {}, worse on {}{}, not told apart on {}{}.",
                    labels[0], score.better.size(), score.worse.size(), after_colon(score.worse),
                    score.even.size(), after_colon(score.even));
    return score.mean_logarithm() > 0 ? best + " does best on the whole. A" + against
                                      : fmt::format("{} does best on the whole; next comes {}: a{}",
                                                    labels[0], best, against);
}

Verdict suite_verdict(const SuiteReport& suite, const std::vector<std::string>& labels) {
    Verdict verdict;
    verdict.text = fmt::format("{} of {} scenes. ", suite.scenes.size(), suite.scenes_planned) +
                   best_on_the_whole(suite, labels);
    for (const Comparison& c : suite.scenes)
        if (verdict_of(c).mark == Mark::bad) {
            verdict.text += " " + c.name + " shows bias.";
            verdict.mark = Mark::bad;
        }
    if (!suite.complete) {
        verdict.text += " The run was stopped early.";
        if (verdict.mark == Mark::none) verdict.mark = Mark::warning;
    }
    return verdict;
}

}  // namespace

void write_suite_index(const SuiteReport& suite, const std::string& directory) {
    std::vector<std::string> labels = technique_labels(suite);
    if (labels.empty()) labels = {"the first technique"};
    const Verdict verdict = suite_verdict(suite, labels);
    HtmlPage page(suite.name + ": error against run time on every scene", verdict.text,
                  verdict.mark);
    add_scenes(page, suite, labels);
    if (labels.size() > 1) add_scores(page, suite, labels);
    page.add_heading("How this was measured");
    page.add_paragraph(
        "Each scene's report holds its curves, its reference with its own error, and how times and "
        "errors were had.");
    page.add_facts({{"Processor", suite.machine.cpu},
                    {"Threads", std::to_string(suite.machine.threads)},
                    {"Midway", suite.machine.version},
                    {"Instruction set", suite.machine.instruction_set},
                    {"Compiler", suite.machine.compiler},
                    {"Run time, this time", format_number(suite.seconds) + " s"}});
    page.add_heading("To make it again");
    page.add_code(suite.command);
    atomic_write((std::filesystem::path(directory) / "index.html").string(), page.finish());
}

}  // namespace midway
