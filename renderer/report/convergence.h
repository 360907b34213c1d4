// Convergence runs: techniques that take turns on one scene, and their errors at points of render
// time. Seeds run one after another; within a seed the techniques advance together in short slices
// of whole passes, so that a noisy machine hurts all alike. Errors are measured at the first pass
// end after each time T 2^(-k/4), where T is the time asked for, with the true time; measuring and
// writing are left out of the times. Curves are kept in files, so that a run that was stopped goes
// on where it was. Throws std::runtime_error where a file cannot be written.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/coverage.h"
#include "render/prepare.h"
#include "render/settings.h"
#include "report/comparison.h"
#include "report/reference.h"

namespace midway {

// A technique as a person names it, with all settings of its renders but the seed.
struct TechniqueChoice {
    std::string label;  // "bdpt:2"
    RenderSettings settings;
    // Of `auto`: its decision in words, and the time that it took, which counts as rendering.
    std::string decision;
    double seconds_before = 0, cpu_seconds_before = 0;
};

// What the technique cannot make although the scene may have it, in words and whole
// (render/coverage.h).
std::vector<std::string> uncovered_paths(const PreparedScene& scene,
                                         const RenderSettings& settings);
std::vector<PathKind> uncovered_kinds(const PreparedScene& scene, const RenderSettings& settings);

struct CompareHooks {
    std::function<bool()> stop;  // asked between slices
    // What is being done, and how many seconds of rendering have been done since the last call.
    std::function<void(const std::string& stage, double seconds)> progress;
    // So many of the planned seconds need not be rendered: they are kept from an earlier run.
    std::function<void(double seconds)> skip;
};

struct ConvergencePlan {
    const PreparedScene* scene = nullptr;
    const Reference* reference = nullptr;
    std::vector<TechniqueChoice> techniques;
    double seconds = 0;  // per technique and seed
    int seeds = 0;       // the first is that of the settings, the others follow it
    int threads = 0;
    std::string folder;  // of the films and points that are kept
    double keep_every_seconds = 60;
};

// One seed of one technique, as far as it went.
struct CurveRun {
    ErrorCurve curve;
    double luminance_a = 0, luminance_b = 0;  // mean of each half of the last image
    double seconds = 0, cpu_seconds = 0;      // of rendering so far
    double metric_seconds = 0;                // of measuring
    std::uint64_t nonfinite = 0;
    PassCounts passes;
};

struct TechniqueRun {
    std::vector<CurveRun> seeds;  // those that were begun
    Image image;                  // of the first seed
};

struct ConvergenceRun {
    std::vector<TechniqueRun> techniques;  // as in the plan
    bool complete = false;                 // all curves reached their time
    bool restarted = false;  // kept curves were of other settings or another reference, or damaged
};

ConvergenceRun run_convergence(const ConvergencePlan& plan, const CompareHooks& hooks);

// A label as part of a file name: "bdpt:2" becomes "bdpt-2".
std::string file_label(const std::string& label);

}  // namespace midway
