// What `midway info --cost` tells: what `auto` weighed up for a scene, and what each leave-out was
// measured to save.
#pragma once

#include <nlohmann/json.hpp>

#include "report/cost.h"

namespace midway {

struct CostJob {
    CostOptions options;
    int size = 192;  // of the square image that is rendered
    bool quiet = false;
};

// {"plan": ..., "measured": ...}; the plan is that of `midway render` without options.
nlohmann::ordered_json cost_json(const PreparedScene& scene, const CostJob& job);

void print_cost(const nlohmann::ordered_json& cost);

}  // namespace midway
