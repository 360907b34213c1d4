#include "report/audit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/audit_paths.h"
#include "report/audit_rows.h"

namespace midway {
namespace {

// Shares of the time that paths and rays take, for progress alone.
std::function<void(double)> part_of(const std::function<void(double)>& tick, double from,
                                    double to) {
    if (!tick) return {};
    return [tick, from, to](double done) { tick(from + (to - from) * done); };
}

PathAudit draw(const Estimator& e, const AuditOptions& o, int unit, std::uint64_t& passes,
               const std::function<void(double)>& tick) {
    const PathSetting setting = path_setting(e);
    PathAudit all(e, unit, o.float_recursion);
    const auto run = [&](const AuditPasses& range) {
        std::vector<PathAudit> sums(worker_count(o.threads), PathAudit(e, unit, o.float_recursion));
        for_each_sample(
            e.crop, range, sums,
            [&](PathAudit& s, int x, int y, std::uint64_t pass) {
                s.add_sample(e, setting, x, y, pass);
            },
            tick);
        for (const PathAudit& s : sums) all.merge(s);
    };
    run({0, 1});
    passes = passes_for(o.paths, all.paths());
    run({1, passes});
    return all;
}

}  // namespace

AuditResult audit(const Scene& scene, const CameraDescription& camera,
                  const RenderSettings& settings, const AuditOptions& options) {
    RenderSettings s = settings;
    s.exponents.assign(audited_exponents.begin(), audited_exponents.end());
    const Estimator e = make_estimator(scene, camera, s);
    AuditResult r;
    r.width = s.width;
    r.height = s.height;
    r.max_bounces = s.max_bounces;
    r.seed = s.seed;
    const double turn = options.rays > 0 ? 0.8 : 1.0;
    draw(e, options, film_unit_exponent(scene.total_power), r.passes,
         part_of(options.tick, 0, turn))
        .report(r);
    if (options.rays > 0)
        r.rays = audit_rays(e, {options.rays, options.threads, part_of(options.tick, turn, 1)});
    r.checks = judge_audit(r);
    return r;
}

bool AuditResult::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const AuditCheck& c) { return c.passed; });
}

double decades_to_overflow(const WeightAudit& w) {
    constexpr double largest = std::numeric_limits<double>::max_exponent10;
    const bool plain = w.exponent == 0 || w.exponent == 1 || w.exponent == 2;
    if (!plain || w.partial_sums.empty()) return std::numeric_limits<double>::infinity();
    return largest - std::max(w.partial_sums.high, -w.partial_sums.low);
}

}  // namespace midway
