// Which technique should render a reference: each renders for a moment, and the lowest relMSE x
// seconds wins. The error is told by the difference of the halves A and B; all are divided by the
// same image, the median over the techniques of each pixel, which no single firefly can spoil.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/reference_render.h"

namespace midway {

struct PilotResult {
    std::string label;
    std::string text;  // the figures, in a sentence
};

// The candidates that leave the least of the scene uncovered: a technique that lacks light which
// another finds has less noise, and makes a wrong reference.
std::vector<const TechniqueChoice*> best_covering(const ReferencePlan& plan);

// Among the best covering. Empty where it was stopped.
std::optional<PilotResult> run_pilot(const ReferencePlan& plan, const CompareHooks& hooks);

}  // namespace midway
