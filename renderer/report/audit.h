// The numerical audit of a scene: paths are drawn by every feasible strategy, and what should hold
// for each of them in exact arithmetic is measured.
//
//   same pdfs   the weights by recursion (integrator/mis.h) against the direct product form in long
//               double logarithms, given the same densities; their sum over all strategies
//   own pdfs    the sum of the weights when each strategy evaluates the densities from its own
//               side, in float geometry: what it misses one by is bias in the image
//   ranges      densities and partial sums, and how far from overflow
//   rays        self-hits and leaks, found by tracing back from what was hit
//   samples     the largest contribution, the share of the brightest, what is not finite
//
// Nothing here is left to chance beyond which paths are drawn; the result depends on scene,
// settings and options alone, not on threads. Decades are powers of ten.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "render/settings.h"
#include "report/audit_rays.h"
#include "report/audit_sums.h"
#include "report/float_recursion.h"

namespace midway {

// The exponents every path is weighed with, whatever the settings say.
inline constexpr std::array audited_exponents{0.0, 0.1, 0.5, 1.0, 2.0, 8.0, 32.0};
inline constexpr size_t power_heuristic = 4;  // index of exponent 2

struct AuditOptions {
    std::int64_t paths = 1000000;      // of at least two edges; whole passes are drawn
    std::int64_t rays = 1000000;       // traced back; 0: none
    int threads = 0;                   // 0: all processors
    bool float_recursion = true;       // the recursion in float beside double
    std::function<void(double)> tick;  // called about ten times a second with the share done
};

// Weights of one exponent.
struct WeightAudit {
    double exponent = 0;
    Deviation recursive;  // |recursive - direct| given the same pdfs, worst over the strategies
    Deviation same_sum;   // |sum - 1| given the same pdfs
    Deviation estimator;  // |estimator's own weight - direct|: the rounding of float geometry
    Deviation own_sum;    // |sum - 1| when every strategy evaluates pdfs from its own side
    // Sum of contribution * (sum - 1) over the sum of contributions: relative error of the image's
    // mean that own pdfs imply, with its standard error: where surfaces are smooth, a single path
    // may stand for most of it.
    double bias = 0, bias_error = 0;
    Range partial_sums;  // vcm and vc of all vertices, decades
};

struct SampleAudit {
    std::uint64_t samples = 0;  // of pixels
    double largest = 0;         // weighted contribution, luminance over the mean sample's
    AuditPlace largest_place;
    double brightest_share = 0;   // of the image in the brightest 0.1 % of samples
    std::uint64_t nonfinite = 0;  // contributions, weights or sums
    AuditPlace nonfinite_place;   // of lowest pixel and sample
    std::uint64_t clamped = 0;    // by the settings
    std::uint64_t inexact = 0;    // contributions with bits below the film's unit
    std::uint64_t overflow = 0;   // contributions the film cannot hold
};

struct AuditCheck {
    std::string name, measured, bar;
    bool passed = true;
    std::string fault;  // strategy, pixel, sample and vertex, where it failed
    AuditPlace place;
};

struct AuditResult {
    int width = 0, height = 0, max_bounces = 0;
    std::uint64_t seed = 0, passes = 0, paths = 0;
    struct Drawn {
        Strategy strategy;
        std::uint64_t paths = 0;
    };
    std::vector<Drawn> strategies;     // those that drew a path
    int longest_path = 0;              // edges
    std::vector<WeightAudit> weights;  // one per audited exponent
    Range pdf_w, pdf_a;                // per solid angle, per area; decades
    SampleAudit samples;
    RayAudit rays;
    FloatRecursion float_recursion;
    std::vector<AuditCheck> checks;
    bool passed() const;
};

// Decades between the largest (or smallest) partial sum and the end of double's range; infinite for
// exponents whose sums are kept as logarithms.
double decades_to_overflow(const WeightAudit& weights);

// Throws std::invalid_argument where the settings make no sense.
AuditResult audit(const Scene& scene, const CameraDescription& camera,
                  const RenderSettings& settings, const AuditOptions& options);

// The verdicts on what was measured; audit() has called it.
std::vector<AuditCheck> judge_audit(const AuditResult& result);

}  // namespace midway
