#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "commands.h"
#include "compare.h"
#include "interrupt.h"
#include "report/html_report.h"
#include "report/summary.h"

namespace midway {
namespace {

TechniqueChoice parse_choice(const std::string& text, const RenderSettings& settings) {
    TechniqueChoice t{text, settings};
    t.settings.exponents = {2};
    choose_technique(text, t.settings);
    // One technique has one name, however it is asked for.
    if (t.settings.technique == Technique::bdpt || text.find(':') != std::string::npos)
        t.label =
            fmt::format("{}:{:g}", to_string(t.settings.technique), t.settings.exponents.front());
    return t;
}

std::string interval_text(const Interval& i, int digits) {
    if (std::isnan(i.value)) return "-";
    if (std::isnan(i.lower)) return fmt::format("{:.{}g}", i.value, digits);
    return fmt::format("{:.{}g} ({:.{}g}..{:.{}g})", i.value, digits, i.lower, digits, i.upper,
                       digits);
}

void print_results(const Comparison& c, const std::string& folder) {
    fmt::print("{}\n{:<10} {:>10} {:>10} {:>8} {:>9}  {:<24} {}\n", c.name, "technique", "relMSE",
               "trimmed", "slope", "bias z", "efficiency", "spp");
    for (const TechniqueResult& t : c.techniques) {
        if (t.curves.empty()) continue;
        fmt::print("{:<10} {:>10.4g} {:>10.4g} {:>8.3f} {:>9.2f}  {:<24} {}{}{}\n", t.label,
                   t.final_mean.relmse, t.final_mean.relmse_trimmed, t.fit.slope.value, t.bias.z,
                   t.efficiency ? interval_text(*t.efficiency, 3) : "1", t.final_mean.spp,
                   t.not_covered.empty() ? "" : "  does not cover all",
                   t.bias.flagged ? "  BIASED" : "");
    }
    fmt::print("{}\n", (std::filesystem::path(folder) / "report.html").string());
    std::fflush(stdout);
}

}  // namespace

void make_folder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw std::runtime_error("cannot make the folder: " + error.message() + " (" + folder +
                                 "); name another one with -o");
}

ComparePlan make_compare_plan(const CompareCommand& c, const std::string& name,
                              const std::string& folder) {
    ComparePlan p;
    p.name = name;
    p.command = c.typed;
    p.settings = c.settings;
    for (const std::string& text : c.techniques) {
        p.techniques.push_back(parse_choice(text, c.settings));
        for (size_t i = 0; i + 1 < p.techniques.size(); ++i)
            if (p.techniques[i].label == p.techniques.back().label)
                usage("--techniques: \"" + p.techniques.back().label + "\" stands there twice");
    }
    if (p.techniques.empty()) usage("--techniques: name at least one");
    if (!c.seconds) usage("--time: say how many seconds each technique and seed may render");
    p.seconds = *c.seconds;
    p.seeds = c.seeds;
    p.threads = c.threads;
    p.reference_file = c.reference;
    p.reference_seconds = c.reference_seconds;
    p.folder = folder;
    p.reference_folder =
        c.references.value_or((std::filesystem::path(c.folder) / "references").string());
    return p;
}

void CompareProgress::show(const std::string& doing) {
    ProgressState s;
    s.done = planned_ > 0 ? std::min(1.0, done_ / planned_) : 0;
    s.doing = doing;
    progress_.update(s);
}

CompareHooks CompareProgress::hooks(const std::string& scene) {
    CompareHooks h;
    h.stop = interrupted;
    h.progress = [this, scene](const std::string& stage, double seconds) {
        done_ += seconds;
        show(scene + ": " + stage);
    };
    h.skip = [this](double seconds) { planned_ -= seconds; };
    return h;
}

std::optional<Comparison> run_compare_scene(ComparePlan plan, const SceneOptions& scene,
                                            CompareProgress& progress, bool quiet) {
    const PreparedScene prepared = prepare_scene(scene);
    if (!quiet) print_warnings(prepared.warnings);
    plan.scene = &prepared;
    std::optional<Comparison> c = compare_scene(plan, progress.hooks(plan.name));
    if (!c) return {};
    write_comparison(*c, plan.folder);
    write_report(*c, plan.folder);
    print_results(*c, plan.folder);
    if (!quiet && c->warnings.size() > prepared.warnings.size())
        print_warnings({c->warnings.begin() + static_cast<std::ptrdiff_t>(prepared.warnings.size()),
                        c->warnings.end()});
    return c;
}

int compare_status(const std::vector<Comparison>& scenes, bool complete) {
    if (!complete) return exit_interrupted;
    for (const Comparison& c : scenes)
        for (const TechniqueResult& t : c.techniques)
            if (t.nonfinite > 0) return exit_nonfinite;
    return exit_done;
}

}  // namespace midway
