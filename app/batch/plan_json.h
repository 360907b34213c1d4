// What `auto` decided, as JSON: for statistics and `midway info --cost`.
#pragma once

#include <nlohmann/json.hpp>

#include "render/pilot.h"

namespace midway {

nlohmann::ordered_json plan_json(const PlanDecision& decision);

}  // namespace midway
