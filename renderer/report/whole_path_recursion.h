// The weights of a whole path by the recursion of integrator/mis.h, called as the estimator calls
// it. The camera's subpath and the light's may hold pdfs of their own (each evaluated from its own
// end); with one path for both, the result is the recursion "given the same pdfs".
#pragma once

#include "integrator/mis.h"
#include "report/direct_form.h"

namespace midway {

// Element s - 1 belongs to (s, k + 1 - s); 0 where the strategy is not feasible or a step of its
// own walks has no density.
std::vector<double> recursive_weights(const PathPdfs& camera, const PathPdfs& light,
                                      const PathSetting& setting, double exponent);

// The same with every number of the recursion a float: what the renderer does not do. Weights may
// be anything, also not finite.
std::vector<double> recursive_weights_in_float(const PathPdfs& pdfs, const PathSetting& setting,
                                               double exponent);

}  // namespace midway
