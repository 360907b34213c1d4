// midway compare on one scene, from plan to figures: reference, curves, fits, verdicts, warnings.
// What was done is kept in the folder, so that a run that was stopped goes on. Throws
// std::runtime_error, or std::invalid_argument for settings that make no sense.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/comparison.h"
#include "report/convergence.h"
#include "report/reference_render.h"

namespace midway {

// Render time of a reference, in multiples of a curve's: its error is then expected to lie 16 times
// below the end of the best curve, because it is rendered by the technique that has the best curve.
constexpr double reference_time_factor = 16;

struct ComparePlan {
    std::string name;     // of the scene, short
    std::string command;  // that makes it again
    const PreparedScene* scene = nullptr;
    RenderSettings settings;  // technique and exponent apart
    std::vector<TechniqueChoice> techniques;
    double seconds = 0;  // per technique and seed
    int seeds = 4, threads = 0;
    std::optional<std::string> reference_file;
    std::optional<double> reference_seconds;  // default: reference_time_factor x seconds
    std::string folder;                       // of the comparison: films/ goes into it
    std::string reference_folder;
    std::int64_t bias_comparisons = 0;  // of the whole run; 0: the techniques of this plan
};

// Empty where it was stopped before any curve was begun.
std::optional<Comparison> compare_scene(const ComparePlan& plan, const CompareHooks& hooks);

// Seconds of rendering of the whole plan, as if nothing were kept of it.
double planned_seconds(const ComparePlan& plan);

Machine this_machine(int threads);

}  // namespace midway
