// Files of a comparison beside its report: DIR/convergence.csv,
// DIR/summary.json (everything but the images and the points), DIR/images/*.exr (the reference,
// with its variance as a layer so that it can be given again, and the last image of the first seed
// of each technique); and of a suite: DIR/table.md, DIR/summary.json. Files appear whole or not at
// all. Throws std::runtime_error.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/comparison.h"

namespace midway {

std::string convergence_csv(const Comparison& comparison);
std::string summary_json(const Comparison& comparison);

void write_comparison(const Comparison& comparison, const std::string& directory);

// Labels of all techniques, in the order of their first appearance.
std::vector<std::string> technique_labels(const SuiteReport& suite);

// Efficiency relative to the first technique, scene by scene, as a table in Markdown.
std::string suite_table(const SuiteReport& suite);

void write_suite(const SuiteReport& suite, const std::string& directory);

}  // namespace midway
