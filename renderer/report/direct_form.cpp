#include "report/direct_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrator/walk.h"

namespace midway {
namespace {

constexpr long double minus_infinity = -std::numeric_limits<long double>::infinity();

long double log_of(double x) {
    return x > 0 ? std::log(static_cast<long double>(x)) : minus_infinity;
}

}  // namespace

PathSetting path_setting(const Estimator& e) {
    return {e.families,         double(e.light_subpaths), e.max_bounces, e.direct_share,
            e.connection_share, e.direct_samples,         e.choices};
}

double light_tracing_count(const PathSetting& s, int edges) {
    return s.light_subpaths * (edges == 2 ? s.direct_share : 1);
}

int next_event_count(const PathSetting& s, int edges) { return edges == 2 ? s.direct_samples : 1; }

double connection_count(const PathSetting& s, bool first) {
    return s.connection_share * (first ? s.choices : 1);
}

bool is_first_rough(const PathPdfs& p, int i) {
    return std::all_of(p.vertices.begin() + 1, p.vertices.begin() + i,
                       [](const VertexPdfs& v) { return v.delta; });
}

bool is_feasible(const PathPdfs& p, const Strategy& k, const PathSetting& setting) {
    const int last = p.edges();
    if (last - 1 > setting.max_bounces || k.s < 1 || k.t < 0 || k.edges() != last) return false;
    switch (family_of(k)) {
        case Family::emitter_hit:
            return setting.families.emitter_hit && p.hittable;
        case Family::next_event:
            return setting.families.next_event && !p.vertices[last - 1].delta;
        case Family::light_tracing:
            return setting.families.light_tracing && light_tracing_count(setting, last) > 0 &&
                   !p.vertices[1].delta;
        case Family::connection:
            return setting.families.connection && !p.vertices[k.s - 1].delta &&
                   !p.vertices[k.s].delta;
    }
    return false;
}

long double log_density(const PathPdfs& p, const Strategy& k, const PathSetting& setting) {
    if (!is_feasible(p, k, setting)) return minus_infinity;
    const int last = p.edges();
    long double sum = 0;
    if (k.s == 1) sum = log_of(light_tracing_count(setting, last));
    if (k.s >= 2 && k.t >= 2) sum = log_of(connection_count(setting, is_first_rough(p, k.s - 1)));
    for (int i = 1; i < k.s; ++i)
        sum += log_of(p.vertices[i].camera_w) + log_of(p.vertices[i].camera_g);
    for (int i = k.s; i < last; ++i)
        sum += log_of(p.vertices[i].light_w) + log_of(p.vertices[i].light_g);
    if (k.t == 1) sum += log_of(next_event_count(setting, last)) + log_of(p.next_event);
    if (k.t >= 2) sum += log_of(p.emission);
    return sum;
}

std::vector<long double> log_densities(const PathPdfs& p, const PathSetting& setting) {
    const int last = p.edges();
    std::vector<long double> logs(last + 1);
    for (int s = 1; s <= last + 1; ++s) logs[s - 1] = log_density(p, {s, last + 1 - s}, setting);
    return logs;
}

std::vector<double> direct_weights(const std::vector<long double>& logs, double exponent) {
    std::vector<double> weights(logs.size(), 0.0);
    const long double largest = *std::max_element(logs.begin(), logs.end());
    if (largest == minus_infinity) return weights;
    std::vector<long double> powers(logs.size(), 0.0L);
    long double sum = 0;
    for (size_t i = 0; i < logs.size(); ++i) {
        // Infeasible strategies stay out for exponent 0 too.
        if (logs[i] == minus_infinity) continue;
        powers[i] = std::exp(static_cast<long double>(exponent) * (logs[i] - largest));
        sum += powers[i];
    }
    for (size_t i = 0; i < logs.size(); ++i) weights[i] = static_cast<double>(powers[i] / sum);
    return weights;
}

std::vector<double> direct_weights(const PathPdfs& p, const PathSetting& setting, double exponent) {
    return direct_weights(log_densities(p, setting), exponent);
}

}  // namespace midway
