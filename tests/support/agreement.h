// Means of rendered images with measured standard errors, and the comparison of two of them: whole
// images and blocks of pixels. The errors are the spread of independent means: of batches of passes
// whose samples are independent (measure), or of whole renders with seeds of their own
// (measure_seeds), each of them as well stratified as the sampler can.
#pragma once

#include <string>
#include <vector>

#include "render/renderer.h"
#include "support/agreement_scenes.h"
#include "support/statistics.h"

namespace midway::test {

// Luminance of the image and of every block (row by row); one entry per batch or seed.
struct Measured {
    RunningMean image;
    std::vector<RunningMean> blocks;
    // What the image and then the blocks were told, in order: one row per batch or seed.
    std::vector<std::vector<double>> told;
};

struct Effort {
    std::uint64_t passes = 4;   // per batch
    int batches = 64;           // per round
    int rounds = 1;             // at most
    double relative_error = 0;  // of the image's mean, at which rounds end
    int block = 6;              // pixels
    int threads = 1;
};

// One result per exponent of the settings.
std::vector<Measured> measure(const AgreementScene& scene, const RenderSettings& settings,
                              const Effort& effort);

struct SeedsEffort {
    std::uint64_t passes = 1024;  // per seed: a power of two, which Sobol points like
    int seeds = 16;               // at least
    int most_seeds = 16;          // where the standard error asked for is not reached before
    double relative_error = 0;    // of the image's mean
    int block = 6;                // pixels
    int threads = 1;
};

// Seeds are settings.seed, settings.seed + 1, ... One result per exponent.
std::vector<Measured> measure_seeds(const AgreementScene& scene, RenderSettings settings,
                                    const SeedsEffort& effort);

// Every strategy up to the bounce limit but the lamp seen directly (camera 2, light 0), which only
// emitter hits can show: with it left out, more subsets of families make the same image.
std::vector<Strategy> all_but_direct_lamps(int max_bounces);

// Whether these families make every path of the scene that can carry light to the camera and that
// any family can make; lamps seen directly left out. Worked out path by path, apart from
// render/coverage.
bool families_cover(const AgreementScene& scene, const Families& families);

// Score of the difference of two means of batches as a standard normal variable: Welch's t, turned
// into z by the formula of Wallace (1959), since the standard errors come from few batches.
double welch_z(const RunningMean& a, const RunningMean& b);

struct Difference {
    double image_z = 0;
    double worst_block_z = 0;
    int worst_block = 0;
    double relative = 0;        // of the images' means, a over b, minus one
    double relative_error = 0;  // standard error of `relative`
};
Difference difference(const Measured& a, const Measured& b);
// The same for two images from the same seeds (exponents that share paths), whose errors have much
// in common: scores and errors are those of the differences, seed by seed.
Difference paired_difference(const Measured& a, const Measured& b);

// The means of two images agree within 3.5 standard errors, and every block within a limit that all
// `comparisons` of a test case share (Sidak, 1e-4 in all).
struct Verdict {
    Difference difference;
    double block_limit = 0;
    bool agrees() const;
    std::string text() const;
};
Verdict judge(const Measured& a, const Measured& b, int comparisons);

// Measures both, once more with other seeds and four times the samples where they disagree, and
// tells how they differ if they still do; empty where they agree. The first exponent of each is
// taken.
std::string disagreement(const AgreementScene& scene, RenderSettings a, RenderSettings b,
                         Effort effort, int comparisons);

}  // namespace midway::test
