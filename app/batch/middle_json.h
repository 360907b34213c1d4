// A measured figure as JSON: for `midway bench` and `midway info --cost`.
#pragma once

#include <nlohmann/json.hpp>

#include "report/bench.h"

namespace midway {

inline nlohmann::ordered_json middle_json(const Middle& m) {
    return {{"median", m.median}, {"low", m.low}, {"high", m.high}};
}

}  // namespace midway
