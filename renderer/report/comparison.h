// What `midway compare` found: plain data from which the report, summary.json and the tables are
// written. Everything a report shows is in here. Intervals hold with 95 % confidence; they come
// from the spread between seeds alone, because the points of one curve are correlated. A number
// that could not be had is NaN.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "image/image.h"
#include "report/error_point.h"

namespace midway {

constexpr double unknown_number = std::numeric_limits<double>::quiet_NaN();

struct Interval {
    double value = unknown_number, lower = unknown_number, upper = unknown_number;
};

struct Machine {
    std::string cpu;  // as the processor calls itself
    int threads = 0;
    std::string version;          // of Midway
    std::string instruction_set;  // that it was built for
    std::string compiler;
};

// A name and its value, to be shown in this order.
struct NamedValue {
    std::string name, value;
};

struct ReferenceInfo {
    std::string source;     // "rendered", or the name of the file that was given
    std::string technique;  // label of the one that rendered it; empty for a file
    std::uint64_t spp = 0;  // all seeds together; 0: unknown
    double seconds = 0;     // of rendering; 0: unknown
    std::string why;        // how technique and time were chosen, in a sentence
    // Error of the reference itself (NaN: unknown), already subtracted from all curves: below the
    // floor no curve means anything, and within ten times of it little.
    double floor_mse = unknown_number, floor_relmse = unknown_number;
    double floor_relmse_trimmed = unknown_number;
    Image image;
    std::optional<Image> variance;  // of its pixels, where it is known
};

// One seed of one technique. Points in order of time, about four in each doubling.
struct ErrorCurve {
    std::uint64_t seed = 0;
    std::vector<ErrorPoint> points;
    bool complete = false;  // reached the time asked for
    bool counts = true;     // false: far shorter than the others, and left out of all that is said
};

// The curve of the mean over the seeds, at common times; lower and upper bound its 95 % interval.
struct BandPoint {
    double seconds = 0;
    double cpu_seconds = unknown_number, spp = 0;  // mean over the seeds
    Interval relmse, relmse_trimmed, mse, smape;
};

// Straight line through log relMSE of the mean curve; the slope against seconds and against samples
// per pixel. -1 is what independent samples of finite variance give.
struct ConvergenceFit {
    Interval slope, slope_spp;
    int points = 0;  // that took part: those above the floor
};

// Render time to reach an error, read off the mean curve.
struct TimeTo {
    double relmse = 0;
    std::optional<double> seconds;  // absent: not reached
    bool at_most = false;           // the curve begins below: the time is its first point's
};

struct BiasVerdict {
    Interval bias;                  // mean over seeds and halves
    double z = unknown_number;      // in standard errors, as of a normal deviate
    double limit = unknown_number;  // |z| above it is more than chance explains
    bool flagged = false;           // it is above, and should not be
    bool expected = false;  // it may be: technique and reference do not cover the same, or settings
                            // make it biased
    std::string text;       // the verdict in a sentence
};

struct TechniqueResult {
    std::string name;                      // path | light | bdpt | ...
    double exponent = 0;                   // of the MIS weights
    std::string label;                     // as asked for: "path", "bdpt:2"
    std::vector<std::string> not_covered;  // kinds of path that it cannot make
    std::vector<std::string> left_out;     // "family: why"
    std::vector<ErrorCurve> curves;        // one per seed that was begun
    std::vector<BandPoint> band;
    ConvergenceFit fit;
    std::vector<TimeTo> time_to;  // the same errors for all techniques
    // (relMSE x seconds) of the first technique over this one's, at the end of the curves: above 1
    // is better than the first. Empty for the first itself.
    std::optional<Interval> efficiency, efficiency_trimmed;
    ErrorPoint final_mean;  // mean of the curves' last points (bias_z is the verdict's)
    BiasVerdict bias;
    Image image;  // last image of the first seed
    std::uint64_t image_seed = 0, image_spp = 0;
    double image_seconds = 0;
    std::uint64_t nonfinite = 0;  // samples that were not finite
};

struct Comparison {
    std::string name;     // short, of the scene: "cornell"
    std::string scene;    // file
    std::string command;  // that makes it again
    std::vector<NamedValue> settings;
    Machine machine;
    ReferenceInfo reference;
    std::vector<TechniqueResult> techniques;
    std::vector<std::string> left_out;  // of the scene: "family: why"
    std::vector<std::string> warnings;
    std::string formula;        // of relMSE and of what was subtracted
    std::string method;         // how times, intervals and z-scores were had
    double time = 0;            // seconds asked for, per technique and seed
    double metric_seconds = 0;  // spent measuring errors, in no curve
    int seeds = 0;              // asked for
    bool complete = false;      // false: stopped early
};

struct SuiteReport {
    std::string name, command;
    Machine machine;
    std::vector<Comparison> scenes;  // each has its report in the folder scenes[i].name
    size_t scenes_planned = 0;
    double seconds = 0;  // of the whole run, this time
    bool complete = false;
};

}  // namespace midway
