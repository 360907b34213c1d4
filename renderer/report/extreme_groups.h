// The groups of the extreme suite, one file each (extreme_NAME.cpp).
#pragma once

#include "report/extreme.h"

namespace midway::extreme {

std::vector<ExtremeCase> scale_cases();
std::vector<ExtremeCase> intensity_cases();
std::vector<ExtremeCase> size_cases();
std::vector<ExtremeCase> glass_cases();  // roughness, indices, bodies of glass
std::vector<ExtremeCase> depth_cases();  // and the geometry term
std::vector<ExtremeCase> exponent_cases();
std::vector<ExtremeCase> light_cases();
std::vector<ExtremeCase> random_cases();
std::vector<ExtremeCase> film_cases();

}  // namespace midway::extreme
