// The built-in extreme suite of `midway check`: small generated scenes at the edge of what a
// renderer meets (scales, intensities, sizes, roughness, distances, depths, exponents, lights,
// random numbers, sums), each with an answer that is known or can be had in a second way.
//
// Seeds are fixed, so a case passes always or never. Comparisons of random means state the chance
// that a correct program fails them; all cases together stay below 1e-3.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace midway {

struct CaseContext {
    int threads = 0;         // 0: all processors
    std::string assets;      // folder of the project's scenes; empty: not found
    double effort = 1;       // times the samples; below 1 the bars grow with the noise
    std::uint64_t seed = 0;  // shifts every seed: for finding out whether a case depends on luck
};

struct CaseResult {
    bool passed = false;
    bool skipped = false;    // what the case needs is not here; `detail` says what
    std::string measured;    // the figure, with its unit
    std::string bar;         // what it must reach
    std::string detail;      // of a failure: where, and with which numbers
    double false_alarm = 0;  // chance that a correct program fails; 0: nothing is left to chance
    double seconds = 0;
};

struct ExtremeCase {
    std::string group, name;
    std::string sentence;  // what is done, and what must come out
    bool cheap = false;    // below a second on one core
    std::function<CaseResult(const CaseContext&)> run;
};

std::vector<ExtremeCase> extreme_cases();

// Runs a case with its time taken; an exception is a failure with its text as detail.
CaseResult run_case(const ExtremeCase& extreme_case, const CaseContext& context);

}  // namespace midway
