// What is kept of a curve between runs: its points in NAME.json and its sums in NAME.film. A curve
// counts only if both are of the same passes and of the key that is asked for.
#pragma once

#include <optional>
#include <string>

#include "report/convergence.h"

namespace midway {

// Everything that a curve's numbers depend on: scene, settings, program, machine, reference.
std::string curve_key(const ConvergencePlan& plan, const RenderSettings& settings);

// The folder's name of one seed of a technique, without ending.
std::string curve_path(const ConvergencePlan& plan, const std::string& label, std::uint64_t seed);

enum class KeptCurve { none, stale, usable };

// `run` is set where the curve is usable. Damaged files are stale.
KeptCurve read_curve(const std::string& path, const std::string& key, CurveRun& run);

void write_curve(const std::string& path, const std::string& key, const CurveRun& run);

// As the processor calls itself.
std::string processor_name();

}  // namespace midway
