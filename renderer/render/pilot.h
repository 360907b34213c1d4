// How `auto` finds out what a scene needs. 65,536 samples of bidirectional path tracing that
// never enter an image (once more where plans differ in their roulette) tell what each way to
// render it, a *plan*, would cost and how noisy it would be; the plan with the smallest error x
// time is taken. A plan is a choice of families and of light subpaths per pixel: none, so that what
// is left is a path tracer; light tracing alone, from a quarter of a subpath to two per pixel;
// connections too, for a quarter of the camera samples or more. With each of them direct light may
// be sampled twice from the first surface.
//
// Of every path that the pilot finds, the balance heuristic's densities are known for all
// strategies, hence also how the strategies of another plan would have shared it: the second moment
// of that plan follows from the same paths (Grittmann, Yazici, Georgiev and Slusallek 2022,
// "Efficiency-aware multiple importance sampling for bidirectional rendering algorithms", the idea;
// the formula below is that of the balance heuristic, Veach 1997, eq. 9.15). A path that one plan
// finds often and another once in a million is weighed right although no sample of the second would
// have met it. What plans have in common, the variance of the full one, is measured from pairs of
// samples of the same pixel, correlations included: with the pilot's second samples of direct light
// and without them.
//
// Costs count rays, each kind at its measured price (pilot.cpp); seconds decide nothing. The
// decision is a function of scene, camera and settings, but for seed and exponents, so it is the
// same for any number of threads, on every shard and in the window.
#pragma once

#include <vector>

#include "render/render_control.h"
#include "render/settings.h"

namespace midway {

// What one plan is expected to do, relative to the full one (all families, one light subpath per
// pixel).
struct PlanForecast {
    Plan plan;
    double cost = 1;   // per sample of every pixel
    double error = 1;  // relMSE at as many samples; infinite where the plan misses paths
    double time() const { return cost * error; }  // to the same error
};

struct PlanDecision {
    Plan plan;
    std::vector<PlanForecast> forecasts;  // of all that were weighed up, simplest kind first
    double seconds = 0;
    double cpu_seconds = 0;  // of the whole process meanwhile; known to choose_plan() alone
    const PlanForecast& chosen() const;
};

// `threads` as in LiveJob: 0 for all processors. Throws as make_estimator(). Nothing comes back
// where `control` ended it.
std::optional<PlanDecision> decide_plan(const Scene& scene, const CameraDescription& camera,
                                        const RenderSettings& settings, int threads,
                                        const RenderControl* control = nullptr);

// Where the technique is `auto` and has no plan yet, decides and keeps the plan in the settings;
// nothing comes back where nothing was to be decided.
std::optional<PlanDecision> choose_plan(const Scene& scene, const CameraDescription& camera,
                                        RenderSettings& settings, int threads);

// "path and light tracing, no connections, half a light subpath per pixel".
std::string describe(const Plan& plan);
// The same with what it is expected to save.
std::string describe(const PlanDecision& decision);

}  // namespace midway
