// The audit's page: verdicts, weights by exponent, ranges, and the recursion in float beside
// double.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/audit.h"
#include "report/html_page.h"

namespace midway {

struct AuditPage {
    std::string scene;
    std::string command;              // that made it
    std::vector<std::string> replay;  // one command per check, empty where it passed
};

// The whole HTML file.
std::string audit_html(const AuditResult& result, const AuditPage& page);

// Two tables and a chart: weight error against the range of the densities, float beside double.
void add_float_recursion(HtmlPage& page, const FloatRecursion& recursion);

// Sums over the cells of an exponent.
struct FloatSummary {
    std::uint64_t paths = 0, spoilt = 0, lost = 0;
    double worst_double = 0;
};
FloatSummary summary(const FloatRecursion& recursion, size_t exponent);

}  // namespace midway
