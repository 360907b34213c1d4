// The extreme suite run as a whole, and its page.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "report/extreme.h"

namespace midway {

struct SuiteCase {
    ExtremeCase what;
    CaseResult result;
};

// GROUP, or GROUP/CASE; everything where `only` is empty. Throws std::invalid_argument with the
// names there are where nothing has this one.
std::vector<ExtremeCase> choose_cases(std::string_view only);

// Runs all cases, cheap ones side by side and each of the others on all threads; `done` is called
// after each with the number finished so far, one call at a time.
std::vector<SuiteCase> run_suite(const std::vector<ExtremeCase>& cases, const CaseContext& context,
                                 const std::function<void(const SuiteCase&, size_t)>& done);

bool suite_passed(const std::vector<SuiteCase>& suite);

// The whole HTML file, with the recursion in float beside double on made-up paths.
std::string suite_html(const std::vector<SuiteCase>& suite, const std::string& command);

}  // namespace midway
