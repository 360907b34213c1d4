#include "report/comparison_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>

#include "render/coverage.h"
#include "render/pilot.h"
#include "report/comparison_text.h"
#include "report/convergence_bias.h"
#include "report/convergence_fit.h"
#include "report/convergence_state.h"

namespace midway {
namespace {

constexpr size_t most_errors_to_reach = 6;

ReferencePlan reference_plan(const ComparePlan& plan) {
    ReferencePlan r;
    r.scene = plan.scene;
    r.name = plan.name;
    r.settings = plan.settings;
    r.candidates = plan.techniques;
    // Whatever the list holds, one of the candidates covers what can be covered.
    const auto is_bdpt = [](const TechniqueChoice& t) { return t.label == "bdpt:2"; };
    if (std::none_of(r.candidates.begin(), r.candidates.end(), is_bdpt)) {
        TechniqueChoice bdpt{"bdpt:2", plan.settings};
        bdpt.settings.technique = Technique::bdpt;
        bdpt.settings.exponents = {2};
        r.candidates.push_back(bdpt);
    }
    r.seconds = plan.reference_seconds.value_or(reference_time_factor * plan.seconds);
    r.pilot_seconds = std::clamp(0.1 * plan.seconds, 0.1, 2.0);
    r.threads = plan.threads;
    r.folder = plan.reference_folder;
    return r;
}

ConvergencePlan convergence_plan(const ComparePlan& plan, const Reference& reference) {
    return {plan.scene,
            &reference,
            plan.techniques,
            plan.seconds,
            plan.seeds,
            plan.threads,
            (std::filesystem::path(plan.folder) / "films").string()};
}

std::optional<RenderedReference> get_reference(const ComparePlan& plan, const CompareHooks& hooks) {
    std::optional<RenderedReference> r;
    if (plan.reference_file) {
        r.emplace();
        r->reference = load_reference(*plan.reference_file);
        r->info.source = *plan.reference_file;
        r->info.spp = r->reference.spp;
        r->info.why = "given";
        const PixelRect all{0, 0, plan.settings.width, plan.settings.height};
        const PixelRect crop = plan.settings.crop.value_or(all);
        check_reference_size(r->reference, crop.width(), crop.height(), *plan.reference_file);
    } else {
        r = render_reference(reference_plan(plan), hooks);
        if (!r) return {};
        if (!plan.reference_seconds)
            r->info.why += fmt::format("; time: {:g} x --time", reference_time_factor);
    }
    const ReferenceFloor floor = reference_floor(r->reference);
    r->info.floor_mse = floor.mse;
    r->info.floor_relmse = floor.relmse;
    r->info.floor_relmse_trimmed = floor.relmse_trimmed;
    r->info.image = r->reference.image;
    r->info.variance = r->reference.variance;
    return r;
}

// Decides what `auto` renders with.
ComparePlan with_decisions(ComparePlan plan) {
    const PreparedScene& p = *plan.scene;
    for (TechniqueChoice& t : plan.techniques)
        if (const auto d = choose_plan(*p.scene, p.camera, t.settings, plan.threads)) {
            t.decision = describe(*d);
            t.seconds_before = d->seconds;
            t.cpu_seconds_before = d->cpu_seconds;
        }
    return plan;
}

// What the reference lacks; nothing where it was given, and is taken as whole.
std::vector<PathKind> reference_gaps(const ComparePlan& plan, const ReferenceInfo& reference) {
    if (plan.reference_file) return {};
    for (const TechniqueChoice& t : reference_plan(plan).candidates)
        if (t.label == reference.technique) return uncovered_kinds(*plan.scene, t.settings);
    return {};
}

// Whether all of `kinds` are among the others.
bool within(const std::vector<PathKind>& kinds, const std::vector<PathKind>& others) {
    return std::ranges::all_of(
        kinds, [&](const PathKind& k) { return std::ranges::find(others, k) != others.end(); });
}

// What neither the technique nor the reference covers makes no difference.
BiasExcuse bias_excuse(const ComparePlan& plan, size_t technique,
                       const std::vector<PathKind>& missing_in_reference) {
    const RenderSettings& s = plan.settings;
    const TechniqueChoice& t = plan.techniques[technique];
    const auto missing = uncovered_kinds(*plan.scene, t.settings);
    BiasExcuse excuse;
    excuse.dark = !within(missing, missing_in_reference);
    excuse.bright = !within(missing_in_reference, missing);
    if (excuse.dark)
        excuse.why = "it does not cover " + uncovered_paths(*plan.scene, t.settings)[0];
    else if (excuse.bright)
        excuse.why = "the reference does not cover the scene";
    if (!s.only.empty() || s.unweighted) return {"not all of the estimate is recorded", true, true};
    if (s.clamp) {
        excuse.dark = true;
        if (excuse.why.empty()) excuse.why = "contributions are clamped";
    }
    return excuse;
}

bool share_a_family(const Families& a, const Families& b) {
    return (a.emitter_hit && b.emitter_hit) || (a.next_event && b.next_event) ||
           (a.light_tracing && b.light_tracing) || (a.connection && b.connection);
}

TechniqueResult describe_technique(const ComparePlan& plan, const TechniqueChoice& choice) {
    TechniqueResult t;
    t.name = to_string(choice.settings.technique);
    t.exponent = choice.settings.exponents.front();
    t.label = choice.label;
    t.not_covered = uncovered_paths(*plan.scene, choice.settings);
    if (!choice.decision.empty()) t.left_out.push_back("auto: " + choice.decision);
    const Families f = families_of(choice.settings.technique);
    for (const FamilyNeed& need : family_needs(scene_features(*plan.scene->scene)))
        if (!need.needed && share_a_family(f, parse_families(need.family)))
            t.left_out.push_back(need.family + ": " + need.why);
    return t;
}

void take_curves(TechniqueResult& t, TechniqueRun run, Comparison& c) {
    for (CurveRun& r : run.seeds) {
        c.metric_seconds += r.metric_seconds;
        t.nonfinite += r.nonfinite;
        t.curves.push_back(std::move(r.curve));
    }
    t.image = std::move(run.image);
    if (t.curves.empty() || t.curves.front().points.empty()) return;
    t.image_seed = t.curves.front().seed;
    t.image_spp = t.curves.front().points.back().spp;
    t.image_seconds = t.curves.front().points.back().seconds;
}

BiasVerdict bias_of(const TechniqueRun& run, const ComparePlan& plan, const Reference& reference,
                    const BiasExcuse& excuse) {
    BiasTest test;
    for (const CurveRun& r : run.seeds) {
        if (!r.curve.counts) continue;
        test.luminances.push_back(r.luminance_a);
        test.luminances.push_back(r.luminance_b);
    }
    test.reference = reference.luminance;
    test.comparisons =
        plan.bias_comparisons > 0 ? plan.bias_comparisons : std::int64_t(plan.techniques.size());
    test.excuse = excuse;
    return judge_bias(test);
}

void fit_all(Comparison& c) {
    for (TechniqueResult& t : c.techniques) {
        t.band = mean_curve(t.curves);
        t.fit = fit_slope(t.curves, c.reference.floor_relmse);
        t.final_mean = mean_of_last(t.curves);
        t.final_mean.bias_z = t.bias.z;
    }
    const std::vector<double> errors =
        errors_to_reach(c.techniques, c.reference.floor_relmse, most_errors_to_reach);
    const TechniqueResult& first = c.techniques.front();
    for (TechniqueResult& t : c.techniques) {
        for (const double e : errors) t.time_to.push_back(time_to_reach(t.band, e));
        if (&t == &first) continue;
        t.efficiency = relative_efficiency(first.curves, t.curves, EfficiencyMetric::relmse);
        t.efficiency_trimmed =
            relative_efficiency(first.curves, t.curves, EfficiencyMetric::relmse_trimmed);
    }
}

}  // namespace

std::optional<Comparison> compare_scene(const ComparePlan& undecided, const CompareHooks& hooks) {
    const ComparePlan plan = with_decisions(undecided);
    const std::optional<RenderedReference> reference = get_reference(plan, hooks);
    if (!reference) return {};
    ConvergenceRun run = run_convergence(convergence_plan(plan, reference->reference), hooks);
    Comparison c;
    c.name = plan.name;
    c.scene = plan.scene->description.source;
    c.command = plan.command;
    c.settings = setting_texts(plan);
    c.machine = this_machine(plan.threads);
    c.reference = reference->info;
    c.time = plan.seconds;
    c.seeds = plan.seeds;
    c.complete = run.complete;
    leave_out_short_seeds(run);
    const std::vector<PathKind> gaps = reference_gaps(plan, reference->info);
    bool begun = false;
    for (size_t i = 0; i < plan.techniques.size(); ++i) {
        TechniqueResult t = describe_technique(plan, plan.techniques[i]);
        begun |= !run.techniques[i].seeds.empty();
        t.bias = bias_of(run.techniques[i], plan, reference->reference, bias_excuse(plan, i, gaps));
        take_curves(t, std::move(run.techniques[i]), c);
        c.techniques.push_back(std::move(t));
    }
    if (!begun) return {};
    fit_all(c);
    for (const FamilyNeed& need : family_needs(scene_features(*plan.scene->scene)))
        if (!need.needed) c.left_out.push_back(need.family + ": " + need.why);
    c.formula = formula_text(c, reference->reference);
    c.method = method_text(c);
    c.warnings = plan.scene->warnings;
    if (run.restarted)
        c.warnings.push_back(
            "curves kept in films/ were of other settings, another machine or another reference, "
            "or damaged; they were made anew");
    add_warnings(c);
    return c;
}

double planned_seconds(const ComparePlan& plan) {
    const double curves = plan.seconds * plan.seeds * double(plan.techniques.size());
    if (plan.reference_file) return curves;
    const ReferencePlan r = reference_plan(plan);
    return curves + r.seconds + r.pilot_seconds * double(r.candidates.size());
}

Machine this_machine(int threads) {
    Machine m;
    m.cpu = processor_name();
    m.threads = threads > 0 ? threads : int(std::max(1u, std::thread::hardware_concurrency()));
    m.version = MIDWAY_VERSION;
    m.instruction_set = MIDWAY_ARCH;
    m.compiler = __VERSION__;
    return m;
}

}  // namespace midway
