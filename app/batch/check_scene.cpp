// The audit of one scene: table, JSON, page.
#include <fmt/format.h>

#include <cmath>

#include "check.h"
#include "image/file.h"
#include "progress.h"
#include "render/json_text.h"
#include "report/audit_html.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

void print_checks(const CheckCommand& c, const AuditResult& r) {
    size_t name = 0, measured = 0;
    for (const AuditCheck& k : r.checks) {
        name = std::max(name, k.name.size());
        measured = std::max(measured, k.measured.size());
    }
    for (const AuditCheck& k : r.checks) {
        fmt::print("  {:<6} {:<{}}  {:>{}}  {}\n", k.passed ? "ok" : "FAILED", k.name, name,
                   k.measured, measured, k.bar);
        if (k.passed) continue;
        fmt::print("         at {}\n", k.fault);
        if (k.place.pass > 0 || k.place.vertex >= 0)
            fmt::print("         replay: {}\n", replay_command(c, k.place));
    }
}

std::string decades(const Range& r) {
    return r.empty() ? std::string("-") : fmt::format("1e{:+.1f} .. 1e{:+.1f}", r.low, r.high);
}

void print_weights(const AuditResult& r) {
    fmt::print("\n  {:>8} {:>10} {:>10} | {:>9} {:>9} {:>9} {:>9} | {:>20} {:>9}\n", "exponent",
               "recursion", "sum", "own: med.", "99.9 %", "worst", "bias", "partial sums",
               "headroom");
    for (const WeightAudit& w : r.weights) {
        const double left = decades_to_overflow(w);
        fmt::print(
            "  {:>8g} {:>10.1e} {:>10.1e} | {:>9.1e} {:>9.1e} {:>9.1e} {:>+9.1e} | {:>20} {:>9}\n",
            w.exponent, w.recursive.worst(), w.same_sum.worst(), w.own_sum.quantile(0.5),
            w.own_sum.quantile(0.999), w.own_sum.worst(), w.bias, decades(w.partial_sums),
            std::isfinite(left) ? fmt::format("{:.0f}", left) : "logs");
    }
}

void print_figures(const AuditResult& r) {
    const SampleAudit& s = r.samples;
    fmt::print("\n  densities: {} per solid angle, {} per area\n", decades(r.pdf_w),
               decades(r.pdf_a));
    fmt::print(
        "  largest contribution: {:.3g} mean samples (pixel {},{} sample {}); the brightest "
        "0.1 % of samples hold {:.2g} % of the image\n",
        s.largest, s.largest_place.x, s.largest_place.y, s.largest_place.pass,
        100 * s.brightest_share);
    fmt::print("  clamped or rejected: {}; rounded below the film's unit: {}\n",
               s.clamped + s.overflow == 0 ? std::string("nothing")
                                           : fmt::format("{}", s.clamped + s.overflow),
               s.inexact);
    const RayAudit& y = r.rays;
    if (y.rays > 0)
        fmt::print(
            "  walks' edges that a connection finds blocked: {} of {}; connections unequal "
            "when traced backwards: {} of {}; walks ended by rounding: {}\n",
            y.blocked.count, y.edges, y.unequal.count, y.pairs, y.stopped);
    const FloatSummary f = summary(r.float_recursion, power_heuristic);
    if (f.paths > 0)
        fmt::print(
            "  in float, exponent 2 would spoil {} of {} paths (weight off by 1e-3), {} lost\n",
            f.spoilt, f.paths, f.lost);
}

Json place_json(const AuditPlace& p) {
    return {{"s", p.strategy.s},
            {"t", p.strategy.t},
            {"pixel", {p.x, p.y}},
            {"sample", p.pass},
            {"vertex", p.vertex}};
}

Json deviation_json(const Deviation& d) {
    return {{"count", d.count()},      {"median", d.quantile(0.5)},
            {"p99", d.quantile(0.99)}, {"p999", d.quantile(0.999)},
            {"worst", d.worst()},      {"at", place_json(d.place())}};
}

// A number that JSON can hold.
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json range_json(const Range& r) {
    if (r.empty()) return nullptr;
    return {{"log10_smallest", r.low}, {"log10_largest", r.high}};
}

Json weights_json(const AuditResult& r) {
    Json all = Json::array();
    for (size_t b = 0; b < r.weights.size(); ++b) {
        const WeightAudit& w = r.weights[b];
        const FloatSummary f = summary(r.float_recursion, b);
        all.push_back({{"exponent", w.exponent},
                       {"recursive_against_direct", deviation_json(w.recursive)},
                       {"sum_same_pdfs", deviation_json(w.same_sum)},
                       {"estimator_against_direct", deviation_json(w.estimator)},
                       {"sum_own_pdfs", deviation_json(w.own_sum)},
                       {"bias", w.bias},
                       {"bias_standard_error", w.bias_error},
                       {"partial_sums", range_json(w.partial_sums)},
                       {"decades_to_overflow", number(decades_to_overflow(w))},
                       {"float_paths", f.paths},
                       {"float_spoilt", f.spoilt},
                       {"float_lost", f.lost}});
    }
    return all;
}

Json fault_json(const RayFault& f) {
    Json j{{"count", f.count}};
    if (f.count > 0) {
        j["object"] = f.object;
        j["at"] = place_json(f.place);
    }
    return j;
}

Json rays_json(const RayAudit& r) {
    return {{"rays", r.rays},
            {"self_hits", fault_json(r.self_hits)},
            {"closed_rays", r.closed_rays},
            {"leaks", fault_json(r.leaks)},
            {"farthest_leak_in_error_bounds", r.farthest_leak},
            {"leaks_elsewhere", fault_json(r.unexplained)},
            {"overlaps", r.overlaps},
            {"edges", r.edges},
            {"edges_blocked", fault_json(r.blocked)},
            {"pairs", r.pairs},
            {"pairs_unequal", fault_json(r.unequal)},
            {"stopped", r.stopped}};
}

Json samples_json(const SampleAudit& s) {
    return {{"samples", s.samples},
            {"largest_over_mean", s.largest},
            {"largest_at", place_json(s.largest_place)},
            {"brightest_share", s.brightest_share},
            {"nonfinite", s.nonfinite},
            {"nonfinite_first", s.nonfinite > 0 ? place_json(s.nonfinite_place) : Json(nullptr)},
            {"clamped", s.clamped},
            {"overflow", s.overflow},
            {"inexact", s.inexact}};
}

}  // namespace

void print_audit(const CheckCommand& c, const AuditResult& r) {
    const auto failed = std::ranges::count(r.checks, false, &AuditCheck::passed);
    fmt::print("{}: {}\n", c.scene.path,
               failed == 0 ? fmt::format("all {} checks passed", r.checks.size())
                           : fmt::format("{} of {} checks FAILED", failed, r.checks.size()));
    fmt::print(
        "  {} paths of up to {} edges by {} strategies, {} samples of {}x{} pixels; {} rays "
        "traced back\n\n",
        r.paths, r.longest_path, r.strategies.size(), r.passes, r.width, r.height, r.rays.rays);
    print_checks(c, r);
    print_weights(r);
    print_figures(r);
}

Json audit_json(const CheckCommand& c, const AuditResult& r) {
    Json j{{"scene", c.scene.path},
           {"passed", r.passed()},
           {"command", check_command_line(c)},
           {"version", MIDWAY_VERSION},
           {"paths", r.paths},
           {"passes", r.passes},
           {"size", {r.width, r.height}},
           {"max_bounces", r.max_bounces},
           {"seed", r.seed},
           {"longest_path", r.longest_path}};
    for (const AuditCheck& k : r.checks) {
        Json check{
            {"name", k.name}, {"measured", k.measured}, {"bar", k.bar}, {"passed", k.passed}};
        if (!k.passed) {
            check["fault"] = k.fault;
            check["replay"] = replay_command(c, k.place);
        }
        j["checks"].push_back(check);
    }
    j["weights"] = weights_json(r);
    j["pdf_per_solid_angle"] = range_json(r.pdf_w);
    j["pdf_per_area"] = range_json(r.pdf_a);
    j["samples"] = samples_json(r.samples);
    j["rays"] = rays_json(r.rays);
    j["strategies"] = Json::array();
    for (const AuditResult::Drawn& d : r.strategies)
        j["strategies"].push_back({{"s", d.strategy.s}, {"t", d.strategy.t}, {"paths", d.paths}});
    return j;
}

int check_scene(const CheckCommand& c) {
    const PreparedScene p = prepare_scene(c.scene);
    if (!c.quiet) print_warnings(p.warnings);
    AuditOptions options = c.audit;
    AuditResult r;
    {
        Progress progress(c.quiet);
        options.tick = [&](double done) { progress.update({done, 0, 0, "auditing"}); };
        r = audit(*p.scene, p.camera, c.settings, options);
    }
    if (c.report) {
        AuditPage page{c.scene.path, check_command_line(c), {}};
        for (const AuditCheck& k : r.checks)
            page.replay.push_back(k.passed ? std::string() : replay_command(c, k.place));
        atomic_write(*c.report, audit_html(r, page));
    }
    if (c.json)
        fmt::print("{}\n", json_text(audit_json(c, r)));
    else
        print_audit(c, r);
    return r.passed() ? exit_done : exit_failed;
}

}  // namespace midway
