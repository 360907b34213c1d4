#include "info_cost.h"

#include <fmt/format.h>

#include <algorithm>

#include "middle_json.h"
#include "plan_json.h"
#include "progress.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

Json row_json(const LeaveOutCost& c) {
    Json j{{"what", c.what}, {"why", c.why}};
    j["seconds_left_out"] = middle_json(c.left_out);
    j["seconds_done"] = middle_json(c.done);
    j["saving"] = middle_json(c.saving);
    j["within_noise"] = c.within_noise();
    j["same_bits"] = c.same_bits;
    j["mean_ratio"] = c.mean_ratio;
    j["mean_ratio_interval"] = {c.mean_low, c.mean_high};
    return j;
}

std::string saving_in_words(const Json& row) {
    const Json& s = row["saving"];
    const auto percent = [&](const char* key) { return 100 * s[key].get<double>(); };
    const std::string interval = fmt::format("({:.1f} to {:.1f})", percent("low"), percent("high"));
    if (row["within_noise"]) return "within noise " + interval;
    return fmt::format("{:.1f} % {}", percent("median"), interval);
}

std::string image_in_words(const Json& row) {
    if (row["same_bits"]) return "same bits";
    const Json& interval = row["mean_ratio_interval"];
    return fmt::format("mean x {:.4f} ({:.4f} to {:.4f})", row["mean_ratio"].get<double>(),
                       interval[0].get<double>(), interval[1].get<double>());
}

void print_plan(const Json& plan) {
    const std::string heading = "relative to plain bdpt, expected";
    size_t width = heading.size();
    for (const Json& f : plan["weighed_up"])
        width = std::max(width, f["what"].get_ref<const std::string&>().size());
    fmt::print("  auto: {}\n    {:<{}} {:>6} {:>9} {:>8}\n", plan["what"].get<std::string>(),
               heading, width, "cost", "error", "time");
    const auto figure = [](const Json& x) {
        return x.is_null() ? std::string("-") : fmt::format("{:.3g}", x.get<double>());
    };
    for (const Json& f : plan["weighed_up"])
        fmt::print("    {:<{}} {:>6} {:>9} {:>8}\n", f["what"].get<std::string>(), width,
                   figure(f["cost"]), figure(f["error"]), figure(f["time"]));
}

}  // namespace

Json cost_json(const PreparedScene& p, const CostJob& job) {
    RenderSettings s;
    s.technique = Technique::automatic;
    Json j;
    j["plan"] = plan_json(*choose_plan(*p.scene, p.camera, s, job.options.threads));
    s.width = s.height = job.size;
    Progress progress(job.quiet);
    const std::vector<LeaveOutCost> rows = measure_cost(
        p, s, job.options,
        [&](const char* what, double done) { progress.update({.done = done, .doing = what}); });
    j["measured"] = {{"size", {job.size, job.size}}, {"rounds", job.options.rounds}};
    j["measured"]["rows"] = Json::array();
    for (const LeaveOutCost& row : rows) j["measured"]["rows"].push_back(row_json(row));
    return j;
}

void print_cost(const Json& cost) {
    print_plan(cost["plan"]);
    const Json& m = cost["measured"];
    const int rounds = m["rounds"].get<int>();
    // Of fewer than six not even the extremes hold the median 95 times in a hundred.
    fmt::print(
        "  measured: microseconds of processor time a sample without it (as it is rendered), with "
        "it, and\n  what leaving it out saves; medians of {} rounds in turns ({})\n",
        rounds, rounds < 6 ? "smallest to largest" : "the interval that holds 95 %");
    fmt::print("    {:<24} {:>8} {:>8}   {:<28} {}\n", "", "without", "with", "saved", "image");
    for (const Json& row : m["rows"]) {
        fmt::print("    {:<24} {:>8.3f} {:>8.3f}   {:<28} {}\n", row["what"].get<std::string>(),
                   1e6 * row["seconds_left_out"]["median"].get<double>(),
                   1e6 * row["seconds_done"]["median"].get<double>(), saving_in_words(row),
                   image_in_words(row));
    }
}

}  // namespace midway
