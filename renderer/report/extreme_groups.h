// The groups of the extreme suite, one file each (extreme_NAME.cpp).
#pragma once

#include "report/extreme.h"

namespace midway::extreme {

std::vector<ExtremeCase> film_cases();

}  // namespace midway::extreme
