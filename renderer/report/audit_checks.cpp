#include <fmt/format.h>

#include <cmath>

#include "report/audit.h"

namespace midway {
namespace {

constexpr double same_pdfs_limit = 1e-9;
constexpr double own_median_limit = 1e-6, own_tail_limit = 1e-3;
constexpr double bias_limit = 1e-5, other_bias_limit = 1e-3;  // exponent 2, and others
// A bias is a mean over the paths drawn: it has to be told from its bar, with at most 1.1e-5 false
// alarms for each exponent where many paths carry it, and fewer where few do. Few paths that carry
// much more than the bar are a fault all the same.
constexpr double bias_deviates = 4.4, most_over_bias_limit = 100;
constexpr double leak_limit = 1e-7, chance_leaks = 3;
constexpr double headroom_limit = 20;  // decades

std::string where(const AuditPlace& p) {
    const std::string vertex = p.vertex < 0    ? std::string()
                               : p.vertex == 0 ? ", vertex 0 (lens)"
                                               : fmt::format(", vertex {}", p.vertex);
    return fmt::format("{}; pixel {},{} sample {}{}", describe(p.strategy), p.x, p.y, p.pass,
                       vertex);
}

std::string walk_at(const RayFault& f) {
    return fmt::format("{} walk, vertex {} on \"{}\"; pixel {},{} sample {}",
                       f.place.strategy.s > 0 ? "camera" : "light", f.place.vertex, f.object,
                       f.place.x, f.place.y, f.place.pass);
}

AuditCheck check(std::string name, std::string measured, std::string bar, bool passed,
                 const AuditPlace& place, const std::string& fault) {
    return {std::move(name),
            std::move(measured),
            std::move(bar),
            passed,
            passed ? std::string() : fault,
            place};
}

// The exponent whose deviation is worst.
const WeightAudit& worst_of(const AuditResult& r, Deviation WeightAudit::*kind) {
    const WeightAudit* worst = &r.weights.front();
    for (const WeightAudit& w : r.weights)
        if ((w.*kind).worst() > (worst->*kind).worst()) worst = &w;
    return *worst;
}

AuditCheck same_pdfs(const AuditResult& r, const char* name, Deviation WeightAudit::*kind) {
    const WeightAudit& w = worst_of(r, kind);
    const Deviation& d = w.*kind;
    return check(name, fmt::format("{:.1e} (exponent {:g})", d.worst(), w.exponent),
                 fmt::format("<= {:.0e}", same_pdfs_limit), d.worst() <= same_pdfs_limit, d.place(),
                 where(d.place()));
}

AuditCheck own_bias(const AuditResult& r, bool power) {
    const double limit = power ? bias_limit : other_bias_limit;
    const auto fails = [&](const WeightAudit& w) {
        const double bias = std::abs(w.bias);
        return !(bias - bias_deviates * w.bias_error <= limit &&
                 bias <= most_over_bias_limit * limit);
    };
    // The largest of those that fail, or of all; what is not a number fails and is never exceeded.
    const WeightAudit* worst = nullptr;
    for (const WeightAudit& w : r.weights) {
        if ((w.exponent == 2) != power) continue;
        if (!worst || fails(w) > fails(*worst) ||
            (fails(w) == fails(*worst) && std::abs(w.bias) > std::abs(worst->bias)))
            worst = &w;
    }
    return check(
        fmt::format("bias that own pdfs imply, {}", power ? "exponent 2" : "other exponents"),
        fmt::format("{:+.1e} +- {:.1e} (exponent {:g})", worst->bias, worst->bias_error,
                    worst->exponent),
        fmt::format("<= {:.0e} + {:g} s.e.", limit, bias_deviates), !fails(*worst),
        worst->own_sum.place(), where(worst->own_sum.place()));
}

void judge_weights(const AuditResult& r, std::vector<AuditCheck>& checks) {
    checks.push_back(same_pdfs(r, "recursion against direct form, same pdfs: worst difference",
                               &WeightAudit::recursive));
    checks.push_back(
        same_pdfs(r, "sum of weights, same pdfs: worst |sum - 1|", &WeightAudit::same_sum));
    const Deviation& own = r.weights[power_heuristic].own_sum;
    const double median = own.quantile(0.5), tail = own.quantile(0.999);
    checks.push_back(check("sum of weights, own pdfs, exponent 2: median |sum - 1|",
                           fmt::format("{:.1e}", median),
                           fmt::format("<= {:.0e}", own_median_limit), median <= own_median_limit,
                           own.place(), where(own.place())));
    checks.push_back(check("sum of weights, own pdfs, exponent 2: 99.9 % of |sum - 1|",
                           fmt::format("{:.1e}", tail), fmt::format("<= {:.0e}", own_tail_limit),
                           tail <= own_tail_limit, own.place(), where(own.place())));
    checks.push_back(own_bias(r, true));
    checks.push_back(own_bias(r, false));
}

void judge_samples(const AuditResult& r, std::vector<AuditCheck>& checks) {
    double headroom = std::numeric_limits<double>::infinity();
    for (const WeightAudit& w : r.weights) headroom = std::min(headroom, decades_to_overflow(w));
    checks.push_back(check("partial sums: decades to overflow", fmt::format("{:.0f}", headroom),
                           fmt::format(">= {:.0f}", headroom_limit), headroom >= headroom_limit, {},
                           "see the table of ranges"));
    const SampleAudit& s = r.samples;
    checks.push_back(check("values that are not finite", fmt::format("{}", s.nonfinite), "0",
                           s.nonfinite == 0, s.nonfinite_place, where(s.nonfinite_place)));
    checks.push_back(check("contributions clamped or outside of the film's range",
                           fmt::format("{}", s.clamped + s.overflow), "0",
                           s.clamped + s.overflow == 0, {}, "see midway render --stats"));
}

void judge_rays(const RayAudit& r, std::vector<AuditCheck>& checks) {
    if (r.rays == 0) return;
    const auto count = [&](const char* name, const RayFault& f, std::uint64_t of, double limit,
                           const std::string& bar) {
        checks.push_back(check(name, fmt::format("{} of {}", f.count, of), bar,
                               double(f.count) <= limit, f.place, walk_at(f)));
    };
    count("rays that meet the triangle they leave", r.self_hits, r.rays, 0, "0");
    count("rays through closed meshes, past an edge", r.leaks, r.closed_rays,
          chance_leaks + leak_limit * double(r.closed_rays),
          fmt::format("<= {:.0e} of them + {:g}", leak_limit, chance_leaks));
    count("rays through closed meshes, elsewhere", r.unexplained, r.closed_rays, 0, "0");
}

}  // namespace

std::vector<AuditCheck> judge_audit(const AuditResult& r) {
    std::vector<AuditCheck> checks;
    if (r.paths > 0) judge_weights(r, checks);
    judge_samples(r, checks);
    judge_rays(r.rays, checks);
    return checks;
}

}  // namespace midway
