#include "report/audit_paths.h"

#include <algorithm>
#include <cmath>

namespace midway {
namespace {

double sum_of(const std::vector<double>& weights) {
    double sum = 0;
    for (const double w : weights) sum += w;
    return sum;
}

// Worst difference over the strategies of a path, with the strategy.
struct WorstStrategy {
    double difference = 0;
    Strategy strategy{1, 1};
};
WorstStrategy worst_difference(const std::vector<double>& a, const std::vector<double>& b) {
    WorstStrategy w;
    const int strategies = static_cast<int>(a.size());
    for (int i = 0; i < strategies; ++i) {
        const double d = std::abs(a[i] - b[i]);
        if (d <= w.difference) continue;
        w = {std::isnan(d) ? std::numeric_limits<double>::infinity() : d,
             {i + 1, strategies - 1 - i}};
        if (std::isinf(w.difference)) break;
    }
    return w;
}

// The vertex whose densities differ most between the two ends.
int vertex_at_fault(const PathPdfs& camera, const PathPdfs& light) {
    int vertex = -1;
    double worst = 0;
    const auto differ = [](double a, double b) {
        return a > 0 && b > 0 ? std::abs(std::log(a / b)) : a == b ? 0.0 : 1e3;
    };
    for (int i = 0; i <= camera.edges(); ++i) {
        const VertexPdfs &c = camera.vertices[i], &l = light.vertices[i];
        // Made by scattering at a neighbour: that is where the directions disagree.
        if (const double d = differ(c.camera_w, l.camera_w); d > worst && i > 0) {
            worst = d;
            vertex = i - 1;
        }
        if (const double d = differ(c.light_w, l.light_w); d > worst && i < camera.edges()) {
            worst = d;
            vertex = i + 1;
        }
    }
    return vertex;
}

}  // namespace

PathAudit::PathAudit(const Estimator& e, int unit_exponent, bool float_recursion)
    : drawn_(strategy_count(e.max_bounces + 1)),
      unit_(unit_exponent),
      brightness_(unit_exponent),
      float_recursion_(float_recursion),
      float_(make_float_recursion({audited_exponents.begin(), audited_exponents.end()})) {}

Int128 PathAudit::fixed(float value) {
    FixedCounts ignored;
    return to_fixed(value, unit_, ignored);
}

// About the scene's power, so that the film's unit (2^-90 of it) suits squares over it too.
double PathAudit::square_scale() const { return std::ldexp(1.0, unit_ + 90); }

void PathAudit::add_sample(const Estimator& e, const PathSetting& setting, int x, int y,
                           std::uint64_t pass) {
    ++samples_;
    sample_luminance_ = 0;
    draw_paths(e, x, y, pass, [&](const DrawnPath& p) {
        const Strategy& k = p.contribution.strategy;
        if (p.edges() > 1 && !e.forms(k)) return;
        add_path(e, setting, p, {x, y, pass, k, k.s - 1});
    });
    brightness_.add(sample_luminance_);
}

void PathAudit::add_path(const Estimator& e, const PathSetting& setting, const DrawnPath& p,
                         const AuditPlace& place) {
    add_contribution(e, p, place);
    if (p.edges() < 2) return;
    ++paths_;
    ++drawn_[strategy_index(p.contribution.strategy)];
    longest_ = std::max(longest_, p.edges());
    add_ranges(p);
    add_same_pdfs(setting, p, place);
    add_own_pdfs(e, setting, p, place);
}

void PathAudit::add_contribution(const Estimator& e, const DrawnPath& p, const AuditPlace& place) {
    const Contribution& c = p.contribution;
    bool finite = is_finite(c.value);
    for (int b = 0; b < e.exponent_count; ++b) finite &= std::isfinite(c.weights[b]);
    for (int i = 1; i < p.edges(); ++i)
        for (int b = 0; b < e.exponent_count; ++b) {
            const mis::State& s = p.surfaces[i].mis[b];
            // The logarithm of a sum of zero is minus infinity.
            finite &= s.vcm < std::numeric_limits<double>::infinity() &&
                      s.vc < std::numeric_limits<double>::infinity();
        }
    if (!finite) {
        if (nonfinite_++ == 0 || place.key() < nonfinite_place_.key()) nonfinite_place_ = place;
        return;
    }
    const vec3 weighted = c.value * static_cast<float>(c.weights[power_heuristic]);
    for (int k = 0; k < 3; ++k) to_fixed(weighted[k], unit_, film_);
    const float l = luminance(weighted);
    sample_luminance_ += l;
    if (l > largest_ || (l == largest_ && place.key() < largest_place_.key())) {
        largest_ = l;
        largest_place_ = place;
    }
}

void PathAudit::add_ranges(const DrawnPath& p) {
    for (int i = 1; i < p.edges(); ++i) {
        const VertexPdfs& v = p.pdfs.vertices[i];
        for (const double w : {v.camera_w, v.light_w}) pdf_w_.add(w);
        for (const double a : {p.pdfs.from_camera(i), p.pdfs.from_light(i)}) pdf_a_.add(a);
        for (size_t b = 0; b < audited_exponents.size(); ++b) {
            const mis::State& s = p.surfaces[i].mis[b];
            const double exponent = audited_exponents[b];
            for (const double sum : {s.vcm, s.vc}) {
                if (exponent == 0 || exponent == 1 || exponent == 2)
                    weights_[b].partial_sums.add(sum);
                else if (std::isfinite(sum))
                    weights_[b].partial_sums.add_log(sum / std::log(10.0));
            }
        }
    }
}

void PathAudit::add_same_pdfs(const PathSetting& setting, const DrawnPath& p, AuditPlace place) {
    const std::vector<long double> logs = log_densities(p.pdfs, setting);
    for (size_t b = 0; b < audited_exponents.size(); ++b) {
        const std::vector<double> direct = direct_weights(logs, audited_exponents[b]);
        const std::vector<double> recursive =
            recursive_weights(p.pdfs, p.pdfs, setting, audited_exponents[b]);
        const Strategy k = p.contribution.strategy;
        Weights& w = weights_[b];
        w.same_sum.add(sum_of(recursive) - 1, place);
        w.estimator.add(p.contribution.weights[b] - direct[k.s - 1], place);
        const WorstStrategy worst = worst_difference(recursive, direct);
        AuditPlace at = place;
        if (worst.difference > 0) at.strategy = worst.strategy;
        w.recursive.add(worst.difference, at);
        if (float_recursion_)
            midway::add_path(float_, b, {&p.pdfs, &direct, &recursive, place}, setting);
    }
}

void PathAudit::add_own_pdfs(const Estimator& e, const PathSetting& setting, const DrawnPath& p,
                             AuditPlace place) {
    const OwnPdfs camera = own_pdfs(e, p, Transport::radiance);
    const OwnPdfs light = own_pdfs(e, p, Transport::importance);
    place.vertex = vertex_at_fault(camera.pdfs, light.pdfs);
    for (size_t b = 0; b < audited_exponents.size(); ++b) {
        const std::vector<double> own =
            recursive_weights(camera.pdfs, light.pdfs, setting, audited_exponents[b]);
        double sum = 0;
        for (int s = 1; s <= p.edges() + 1; ++s) {
            if (s == p.contribution.strategy.s) {
                sum += p.contribution.weights[b];
                continue;
            }
            // Both ends of the connecting edge have to scatter along it.
            const bool camera_scatters = s == 1 || s > p.edges() || camera.scatters[s - 1];
            const bool light_scatters = s >= p.edges() || light.scatters[s];
            if (camera_scatters && light_scatters) sum += own[s - 1];
        }
        Weights& w = weights_[b];
        w.own_sum.add(sum - 1, place);
        const float carried =
            luminance(p.contribution.value) * static_cast<float>(p.contribution.weights[b]);
        if (!std::isfinite(carried) || !std::isfinite(sum)) continue;
        const float missed = carried * static_cast<float>(sum - 1);
        w.energy += fixed(carried);
        w.bias += fixed(missed);
        w.bias_squares += fixed(static_cast<float>(missed * (missed / square_scale())));
    }
}

void PathAudit::merge(const PathAudit& o) {
    for (size_t b = 0; b < weights_.size(); ++b) {
        Weights& w = weights_[b];
        const Weights& v = o.weights_[b];
        w.recursive.merge(v.recursive);
        w.same_sum.merge(v.same_sum);
        w.estimator.merge(v.estimator);
        w.own_sum.merge(v.own_sum);
        w.energy += v.energy;
        w.bias += v.bias;
        w.bias_squares += v.bias_squares;
        w.partial_sums.merge(v.partial_sums);
    }
    for (size_t i = 0; i < drawn_.size(); ++i) drawn_[i] += o.drawn_[i];
    paths_ += o.paths_;
    samples_ += o.samples_;
    longest_ = std::max(longest_, o.longest_);
    pdf_w_.merge(o.pdf_w_);
    pdf_a_.merge(o.pdf_a_);
    brightness_.merge(o.brightness_);
    if (o.largest_ > largest_ ||
        (o.largest_ == largest_ && o.largest_place_.key() < largest_place_.key())) {
        largest_ = o.largest_;
        largest_place_ = o.largest_place_;
    }
    if (o.nonfinite_ > 0 && (nonfinite_ == 0 || o.nonfinite_place_.key() < nonfinite_place_.key()))
        nonfinite_place_ = o.nonfinite_place_;
    nonfinite_ += o.nonfinite_;
    film_.inexact += o.film_.inexact;
    film_.overflow += o.film_.overflow;
    float_.merge(o.float_);
}

void PathAudit::report(AuditResult& r) const {
    r.paths = paths_;
    r.longest_path = longest_;
    for (int edges = 2; strategy_index({1, edges}) < drawn_.size(); ++edges)
        for (int s = 1; s <= edges + 1; ++s) {
            const Strategy k{s, edges + 1 - s};
            if (drawn_[strategy_index(k)] > 0)
                r.strategies.push_back({k, drawn_[strategy_index(k)]});
        }
    for (size_t b = 0; b < weights_.size(); ++b) {
        const Weights& w = weights_[b];
        const double energy = from_fixed(w.energy, unit_);
        const double squares = from_fixed(w.bias_squares, unit_) * square_scale();
        r.weights.push_back({audited_exponents[b], w.recursive, w.same_sum, w.estimator, w.own_sum,
                             energy > 0 ? from_fixed(w.bias, unit_) / energy : 0,
                             energy > 0 ? std::sqrt(squares) / energy : 0, w.partial_sums});
    }
    r.pdf_w = pdf_w_;
    r.pdf_a = pdf_a_;
    SampleAudit& s = r.samples;
    s.samples = samples_;
    const double total = brightness_.total();
    if (total > 0) s.largest = double(largest_) * double(samples_) / total;
    s.largest_place = largest_place_;
    s.brightest_share = brightness_.share_of_brightest(0.001, samples_);
    s.nonfinite = nonfinite_;
    s.nonfinite_place = nonfinite_place_;
    s.inexact = film_.inexact;
    s.overflow = film_.overflow;
    r.float_recursion = float_;
}

void BrightnessHistogram::add(float l) {
    if (!(l > 0) || !std::isfinite(l)) return;
    const double place = (std::log2(double(l)) - lowest) * steps;
    Bin& bin = bins_[static_cast<size_t>(std::clamp(place, 0.0, bin_count - 1.0))];
    FixedCounts ignored;
    ++bin.count;
    bin.sum += to_fixed(l, unit_, ignored);
}

void BrightnessHistogram::merge(const BrightnessHistogram& o) {
    for (size_t i = 0; i < bins_.size(); ++i) {
        bins_[i].count += o.bins_[i].count;
        bins_[i].sum += o.bins_[i].sum;
    }
}

double BrightnessHistogram::total() const {
    Int128 sum = 0;
    for (const Bin& bin : bins_) sum += bin.sum;
    return from_fixed(sum, unit_);
}

double BrightnessHistogram::share_of_brightest(double part, std::uint64_t samples) const {
    double left = part * static_cast<double>(samples), sum = 0;
    for (auto bin = bins_.rbegin(); bin != bins_.rend() && left > 0; ++bin) {
        if (bin->count == 0) continue;
        // Of the last step as many as are wanted, each taken as bright as the step's mean.
        const double taken = std::min(left, static_cast<double>(bin->count));
        sum += from_fixed(bin->sum, unit_) * (taken / static_cast<double>(bin->count));
        left -= taken;
    }
    const double all = total();
    return all > 0 ? sum / all : 0;
}

}  // namespace midway
