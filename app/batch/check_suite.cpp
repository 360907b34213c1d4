// The built-in suite of extreme cases: table, JSON, page.
#include <fmt/format.h>

#include <filesystem>

#include "check.h"
#include "image/file.h"
#include "render/json_text.h"
#include "report/audit_suite.h"

namespace midway {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The project's scenes: beside the working folder or above the program.
std::string find_assets() {
    std::error_code error;
    fs::path folder = fs::current_path(error);
    for (const fs::path& start : {folder, fs::read_symlink("/proc/self/exe", error).parent_path()})
        for (folder = start; !folder.empty(); folder = folder.parent_path()) {
            if (fs::exists(folder / "assets" / "cornell.glb", error))
                return (folder / "assets").string();
            if (folder == folder.root_path()) break;
        }
    return {};
}

const char* verdict(const CaseResult& r) {
    return r.skipped ? "skipped" : r.passed ? "ok" : "FAILED";
}

std::string name_of(const SuiteCase& c) { return c.what.group + "/" + c.what.name; }

void print_suite(const std::vector<SuiteCase>& suite) {
    size_t failed = 0, skipped = 0, name = 0, measured = 0;
    double seconds = 0;
    for (const SuiteCase& c : suite) {
        failed += !c.result.passed && !c.result.skipped;
        skipped += c.result.skipped;
        seconds += c.result.seconds;
        name = std::max(name, name_of(c).size());
        measured = std::max(measured, c.result.measured.size());
    }
    fmt::print("extreme cases: {}{}, {:.0f} s\n\n",
               failed == 0 ? fmt::format("all {} passed", suite.size() - skipped)
                           : fmt::format("{} of {} FAILED", failed, suite.size()),
               skipped == 0 ? std::string() : fmt::format(", {} skipped", skipped), seconds);
    for (const SuiteCase& c : suite) {
        const CaseResult& r = c.result;
        fmt::print("  {:<7} {:<{}}  {:<{}}  {}\n", verdict(r), name_of(c), name, r.measured,
                   measured, r.bar);
        if (!r.passed || r.skipped) fmt::print("          {}: {}\n", c.what.sentence, r.detail);
    }
}

Json suite_json(const std::vector<SuiteCase>& suite, const std::string& command) {
    Json j{{"passed", suite_passed(suite)}, {"command", command}, {"version", MIDWAY_VERSION}};
    j["cases"] = Json::array();
    for (const SuiteCase& c : suite) {
        const CaseResult& r = c.result;
        j["cases"].push_back({{"group", c.what.group},
                              {"name", c.what.name},
                              {"sentence", c.what.sentence},
                              {"measured", r.measured},
                              {"bar", r.bar},
                              {"passed", r.passed},
                              {"skipped", r.skipped},
                              {"detail", r.detail},
                              {"false_alarm", r.false_alarm},
                              {"seconds", r.seconds}});
    }
    return j;
}

}  // namespace

int check_suite(const CheckCommand& c) {
    const std::vector<ExtremeCase> cases = choose_cases(c.only);
    CaseContext context;
    context.threads = c.audit.threads;
    context.assets = c.assets.empty() ? find_assets() : c.assets;
    context.effort = c.effort;
    context.seed = c.settings.seed;
    const std::vector<SuiteCase> suite =
        run_suite(cases, context, [&](const SuiteCase& s, size_t done) {
            if (!c.quiet)
                fmt::print(stderr, "midway: {}/{} {} {} ({:.1f} s)\n", done, cases.size(),
                           verdict(s.result), name_of(s), s.result.seconds);
        });
    std::string command = "midway check";
    if (!c.only.empty()) command += " --only " + c.only;
    if (c.effort != 1) command += fmt::format(" --effort {}", c.effort);
    if (c.settings.seed != 0) command += fmt::format(" --seed {}", c.settings.seed);
    if (c.report) atomic_write(*c.report, suite_html(suite, command));
    if (c.json)
        fmt::print("{}\n", json_text(suite_json(suite, command)));
    else
        print_suite(suite);
    return suite_passed(suite) ? exit_done : exit_failed;
}

}  // namespace midway
