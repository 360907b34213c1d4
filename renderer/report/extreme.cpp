#include "report/extreme.h"

#include <chrono>
#include <exception>

#include "report/extreme_groups.h"

namespace midway {

std::vector<ExtremeCase> extreme_cases() {
    std::vector<ExtremeCase> all;
    for (const auto group : {extreme::scale_cases, extreme::intensity_cases, extreme::size_cases,
                             extreme::glass_cases, extreme::depth_cases, extreme::exponent_cases,
                             extreme::light_cases, extreme::random_cases, extreme::film_cases})
        for (ExtremeCase& c : group()) all.push_back(std::move(c));
    return all;
}

CaseResult run_case(const ExtremeCase& c, const CaseContext& context) {
    const auto start = std::chrono::steady_clock::now();
    CaseResult r;
    try {
        r = c.run(context);
    } catch (const std::exception& error) {
        r.passed = false;
        r.detail = error.what();
    }
    r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return r;
}

}  // namespace midway
