// One sample as a table on stdout: --debug-pixel.
#pragma once

#include "report/inspect.h"

namespace midway {

// Both subpaths vertex by vertex, then every full path that was found with all strategies that
// could have found it.
void print_sample(const InspectedSample& sample);

}  // namespace midway
