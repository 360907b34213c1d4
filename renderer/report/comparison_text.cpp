#include "report/comparison_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "render/command_line.h"
#include "report/convergence_bias.h"

namespace midway {
namespace {

// Where the worst pixels carry this much more of the error than the others.
constexpr double heavy_tail = 10;
// Curves end this far above the reference's own error, or are warned of.
constexpr double floor_margin = 10;

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& w : words) text += (text.empty() ? "" : "; ") + w;
    return text;
}

void warn_of_technique(const TechniqueResult& t, Comparison& c) {
    const auto warn = [&](const std::string& text) { c.warnings.push_back(t.label + " " + text); };
    if (!t.not_covered.empty())
        warn("does not cover: " + joined(t.not_covered) +
             " (its errors hold what is missing; its efficiency there means nothing)");
    if (t.bias.flagged) warn("differs from the reference in the mean: " + t.bias.text);
    if (t.nonfinite > 0) warn(fmt::format("gave {} samples that were not finite", t.nonfinite));
    const double end = t.final_mean.relmse;
    const auto warn_of_floor = [&](const char* metric, double error, double floor) {
        if (!t.curves.empty() && error < floor_margin * floor)
            warn(
                fmt::format("ends at {} {:.3g}, within {:g} times of the reference's own {:.3g}: "
                            "give the reference more time (--reference-time)",
                            metric, error, floor_margin, floor));
    };
    warn_of_floor("relMSE", end, c.reference.floor_relmse);
    warn_of_floor("trimmed relMSE", t.final_mean.relmse_trimmed, c.reference.floor_relmse_trimmed);
    if (t.final_mean.relmse_trimmed > 0 && end > heavy_tail * t.final_mean.relmse_trimmed)
        warn(
            "has most of its error in 0.1 % of the pixels: mean, slope, efficiency and z-score "
            "of so few are unreliable, the trimmed error is not");
}

void warn_of_short_seeds(Comparison& c) {
    std::set<std::uint64_t> seeds;
    for (const TechniqueResult& t : c.techniques)
        for (const ErrorCurve& curve : t.curves)
            if (!curve.counts) seeds.insert(curve.seed);
    for (const std::uint64_t seed : seeds)
        c.warnings.push_back(
            fmt::format("seed {} went less than half as far as the others: its errors are in "
                        "convergence.csv alone",
                        seed));
}

}  // namespace

std::vector<NamedValue> setting_texts(const ComparePlan& plan) {
    const RenderSettings& s = plan.settings;
    std::vector<NamedValue> v;
    const auto add = [&](const std::string& name, const std::string& value) {
        v.push_back({name, value});
    };
    add("size", fmt::format("{}x{}", s.width, s.height));
    if (s.crop)
        add("crop", fmt::format("{},{},{},{}", s.crop->x0, s.crop->y0, s.crop->x1, s.crop->y1));
    add("time per technique and seed", fmt::format("{:g} s", plan.seconds));
    add("seeds", fmt::format("{} ({} to {})", plan.seeds, s.seed, s.seed + plan.seeds - 1));
    add("max bounces", std::to_string(s.max_bounces));
    add("sampler", std::string(to_string(s.sampler)));
    add("filter", std::string(to_string(s.filter)));
    if (s.clamp) add("clamp", fmt::format("{:g} (biased)", *s.clamp));
    if (s.families) add("families", to_string(*s.families));
    for (const Strategy& k : s.only) add("only", fmt::format("{},{}", k.s, k.t));
    if (s.unweighted) add("unweighted", "yes");
    const SceneOptions& o = plan.scene->options;
    if (const std::string line = scene_options_line(o); !line.empty()) add("scene options", line);
    if (!o.edits.empty()) add("edits", "of single lights or materials, by the session");
    if (plan.scene->description.sky && !o.sky) add("sky", plan.scene->description.sky->source);
    if (!plan.scene->camera.name.empty()) add("camera", plan.scene->camera.name);
    add("scene hash", fmt::format("{:016x}", plan.scene->hash));
    return v;
}

std::string formula_text(const Comparison& c, const Reference& r) {
    std::string text =
        "relMSE = mean over pixels and channels of ((x - r)^2 - v) / (r^2 + 0.01 m^2), with x the "
        "image, r the reference, m the mean luminance of r and v the variance of r. relMSE "
        "trimmed: without the 0.1 % of the pixels that are worst. MSE = mean of (x - r)^2 - v. "
        "SMAPE = mean of |x - r| / (|x| + |r|). FLIP: mean of the map of Andersson et al. (2020) "
        "at "
        "67 pixels per degree, of colours cut off at 1 without exposure. Bias = mean luminance of "
        "x over m, less 1. ";
    if (r.variance)
        text += fmt::format(
            "v is known from the spread of independent parts of the reference; its relMSE of "
            "{:.3g} "
            "is subtracted from all curves and drawn as the floor.",
            c.reference.floor_relmse);
    else
        text += "v is not known of this reference and is taken as 0: nothing is subtracted.";
    return text;
}

std::string method_text(const Comparison& c) {
    return fmt::format(
        "Techniques took turns in slices of at most half a second of whole passes; errors are "
        "those of "
        "the first pass that ends after {:g} s x 2^(-k/4). Times are of rendering, and begin with "
        "what auto took to decide, measured once; measuring took {:.3g} s in all and is in no "
        "curve. Intervals hold with 95 % confidence and come from the "
        "spread between seeds (Student's t; jackknife for slopes and efficiencies), because the "
        "points of one curve are correlated. Slope: least squares of log relMSE of the mean over "
        "seeds, above the floor. Efficiency: relMSE x seconds of the first technique over that of "
        "the other, averaged over the last doubling of time. Bias: Student's t over the halves A "
        "and B of all seeds, given as a normal deviate; flagged where a run of right techniques "
        "would flag any with a chance of {:g} (Sidak).",
        c.time, c.metric_seconds, bias_false_alarm);
}

void add_warnings(Comparison& c) {
    if (!c.complete)
        c.warnings.push_back(
            "stopped early: the same command goes on where this report ends, and completes it");
    if (c.seeds < 2) c.warnings.push_back("one seed alone: no interval is known (--seeds)");
    if (std::isnan(c.reference.floor_relmse))
        c.warnings.push_back(
            "the error of the reference is not known: curves flatten where they meet it, and its "
            "mean is taken to be as noisy as each technique's. A .film, or an EXR with a layer "
            "\"variance\" (--aov), would tell it");
    warn_of_short_seeds(c);
    for (const TechniqueResult& t : c.techniques) warn_of_technique(t, c);
}

}  // namespace midway
