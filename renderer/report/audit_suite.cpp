#include "report/audit_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "report/audit_html.h"
#include "report/audit_rows.h"

namespace midway {

std::vector<ExtremeCase> choose_cases(std::string_view only) {
    std::vector<ExtremeCase> chosen;
    std::string groups;
    for (ExtremeCase& c : extreme_cases()) {
        if (groups.find(c.group) == std::string::npos)
            groups += (groups.empty() ? "" : ", ") + c.group;
        if (only.empty() || only == c.group || only == c.group + "/" + c.name)
            chosen.push_back(std::move(c));
    }
    if (chosen.empty())
        throw std::invalid_argument("the suite has no case \"" + std::string(only) +
                                    "\" (--only); use GROUP or GROUP/CASE, groups are " + groups);
    return chosen;
}

std::vector<SuiteCase> run_suite(const std::vector<ExtremeCase>& cases, const CaseContext& context,
                                 const std::function<void(const SuiteCase&, size_t)>& done) {
    std::vector<SuiteCase> suite;
    for (const ExtremeCase& c : cases) suite.push_back({c, {}});
    std::mutex mutex;
    size_t finished = 0;
    const auto run = [&](SuiteCase& c, int threads) {
        CaseContext own = context;
        own.threads = threads;
        c.result = run_case(c.what, own);
        const std::lock_guard lock(mutex);
        done(c, ++finished);
    };
    {
        std::atomic<size_t> next{0};
        std::vector<std::jthread> workers;
        for (int i = 0; i < worker_count(context.threads); ++i)
            workers.emplace_back([&] {
                for (size_t k = next++; k < suite.size(); k = next++)
                    if (suite[k].what.cheap) run(suite[k], 1);
            });
    }
    for (SuiteCase& c : suite)
        if (!c.what.cheap) run(c, worker_count(context.threads));
    return suite;
}

bool suite_passed(const std::vector<SuiteCase>& suite) {
    return std::ranges::all_of(
        suite, [](const SuiteCase& c) { return c.result.passed || c.result.skipped; });
}

std::string suite_html(const std::vector<SuiteCase>& suite, const std::string& command) {
    const auto failed = std::ranges::count_if(
        suite, [](const SuiteCase& c) { return !c.result.passed && !c.result.skipped; });
    double false_alarm = 0, seconds = 0;
    for (const SuiteCase& c : suite) {
        false_alarm += c.result.false_alarm;
        seconds += c.result.seconds;
    }
    HtmlPage page("Extreme cases",
                  failed == 0 ? fmt::format("All {} cases passed.", suite.size())
                              : fmt::format("{} of {} cases failed.", failed, suite.size()),
                  failed == 0 ? Mark::good : Mark::bad);
    page.add_code(command);
    page.add_paragraph(fmt::format(
        "Seeds are fixed. The chance that a correct program fails any case after a change of its "
        "random numbers is {}. All cases together took {} s.",
        format_number(false_alarm), format_number(seconds)));
    HtmlTable t;
    t.caption = "Small generated scenes, each with an answer that is known or had in a second way.";
    t.columns = {"case", "what must come out", "measured", "bar", "seconds"};
    for (const SuiteCase& c : suite) {
        const CaseResult& r = c.result;
        HtmlCell measured(r.skipped ? "skipped" : r.measured, r.skipped  ? Mark::warning
                                                              : r.passed ? Mark::good
                                                                         : Mark::bad);
        if (r.skipped || !r.passed) measured.detail = r.detail;
        t.rows.push_back({c.what.group + "/" + c.what.name, c.what.sentence, measured, r.bar,
                          format_number(r.seconds)});
    }
    page.add_heading("Cases");
    page.add_table(t);
    page.add_heading("Float beside double");
    page.add_paragraph(
        "Made-up paths of 12 vertices, a quarter of them smooth, whose densities spread over up to "
        "40 decades.");
    add_float_recursion(page, made_up_float_recursion({}));
    return page.finish();
}

}  // namespace midway
