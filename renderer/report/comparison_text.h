// The words of a comparison: settings, formulas, method and warnings.
#pragma once

#include "report/comparison_run.h"

namespace midway {

std::vector<NamedValue> setting_texts(const ComparePlan& plan);

std::string formula_text(const Comparison& comparison, const Reference& reference);
std::string method_text(const Comparison& comparison);

// Appends what a reader must know before believing the curves.
void add_warnings(Comparison& comparison);

}  // namespace midway
