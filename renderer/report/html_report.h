// The HTML pages of `midway compare`: for each scene DIRECTORY/report.html, one file that holds
// its curves, tables and images (html_page.h); for a suite DIRECTORY/index.html, the table of all
// scenes with links to their reports. Losses are shown like gains: a technique counts as better or
// worse than the first only where the interval says so. Throws std::runtime_error with one line
// "WHAT (WHERE); REMEDY" where a file cannot be written; pages appear whole or not at all.
#pragma once

#include <string>

#include "report/comparison.h"
#include "report/html_page.h"

namespace midway {

void write_report(const Comparison& comparison, const std::string& directory);

void write_suite_index(const SuiteReport& suite, const std::string& directory);

// The outcome in a sentence or two of plain words, and its colour: bad where a technique is biased
// that should not be, warning where the run was stopped or no technique is shown to be best.
struct Verdict {
    std::string text;
    Mark mark = Mark::none;
    std::string best = {};  // label of the technique that is best; empty where none is shown to be
};
Verdict verdict_of(const Comparison& comparison);

// The mean curves of all techniques: relMSE, trimmed relMSE, MSE or SMAPE against seconds,
// processor seconds or samples, as far as the comparison knows them; bands are 95 % intervals of
// the mean.
HtmlChart convergence_chart(const Comparison& comparison);

// "5.4" with "4.8 to 6.1" under it; good or bad where the whole interval lies above or below one,
// and the technique covers the scene.
HtmlCell efficiency_cell(const std::optional<Interval>& efficiency, const TechniqueResult& of);

}  // namespace midway
