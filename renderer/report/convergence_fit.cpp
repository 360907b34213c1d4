#include "report/convergence_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "math/student.h"

namespace midway {
namespace {

constexpr double confidence = 0.95;

using Field = double (*)(const ErrorPoint&);

double spp_of(const ErrorPoint& p) { return double(p.spp); }
double cpu_of(const ErrorPoint& p) { return p.cpu_seconds; }
double mse_of(const ErrorPoint& p) { return p.mse; }
double relmse_of(const ErrorPoint& p) { return p.relmse; }
double trimmed_of(const ErrorPoint& p) { return p.relmse_trimmed; }
double smape_of(const ErrorPoint& p) { return p.smape; }

// Share of the way in log time from point i - 1 to point i at which `seconds` lies.
struct Place {
    size_t i = 1;
    double share = 0;
};

Place place_of(const ErrorCurve& c, double seconds) {
    const auto above =
        std::lower_bound(c.points.begin() + 1, c.points.end() - 1, seconds,
                         [](const ErrorPoint& p, double t) { return p.seconds < t; });
    const double t0 = (above - 1)->seconds, t1 = above->seconds;
    const double share = t1 > t0 ? std::log(seconds / t0) / std::log(t1 / t0) : 1;
    return {size_t(above - c.points.begin()), std::clamp(share, 0.0, 1.0)};
}

// Errors fall like 1 / time: their product with time is interpolated, which is nearly constant and
// may be below zero.
double error_at(const ErrorCurve& c, Field field, double seconds) {
    if (c.points.size() == 1) return field(c.points.front());
    const Place k = place_of(c, seconds);
    const ErrorPoint &a = c.points[k.i - 1], &b = c.points[k.i];
    const double product = (1 - k.share) * field(a) * a.seconds + k.share * field(b) * b.seconds;
    return product / seconds;
}

// Quantities that grow with time: linear in the logarithm of both.
double growing_at(const ErrorCurve& c, Field field, double seconds) {
    if (c.points.size() == 1) return field(c.points.front());
    const Place k = place_of(c, seconds);
    const double a = field(c.points[k.i - 1]), b = field(c.points[k.i]);
    if (!(a > 0 && b > 0)) return (1 - k.share) * a + k.share * b;
    return a * std::pow(b / a, k.share);
}

bool has_a_say(const ErrorCurve& c) { return c.counts && !c.points.empty(); }

std::vector<const ErrorCurve*> with_a_say(std::span<const ErrorCurve> curves) {
    std::vector<const ErrorCurve*> result;
    for (const ErrorCurve& c : curves)
        if (has_a_say(c)) result.push_back(&c);
    return result;
}

// The times of the first curve's points within the times that all curves reach.
std::vector<double> common_times(const std::vector<const ErrorCurve*>& curves) {
    if (curves.empty()) return {};
    double first = 0, last = std::numeric_limits<double>::infinity();
    for (const ErrorCurve* c : curves) {
        first = std::max(first, c->points.front().seconds);
        last = std::min(last, c->points.back().seconds);
    }
    if (first >= last) return {last};
    std::vector<double> times{first};
    for (const ErrorPoint& p : curves.front()->points)
        if (p.seconds > first * 1.02 && p.seconds < last / 1.02) times.push_back(p.seconds);
    times.push_back(last);
    return times;
}

double mean_over(const std::vector<const ErrorCurve*>& curves,
                 const std::function<double(const ErrorCurve&)>& value) {
    double sum = 0;
    for (const ErrorCurve* c : curves) sum += value(*c);
    return sum / double(curves.size());
}

Interval band_of(const std::vector<const ErrorCurve*>& curves, Field field, double seconds) {
    std::vector<double> values;
    for (const ErrorCurve* c : curves) values.push_back(error_at(*c, field, seconds));
    const MeanInterval m = mean_interval(values, confidence);
    if (!(m.mean > 0)) return {m.mean, unknown_number, unknown_number};
    const double spread = std::exp((m.upper - m.mean) / m.mean);
    return {m.mean, m.mean / spread, m.mean * spread};
}

// Value from all seeds, and its interval from the values without each seed in turn: those stand for
// K x - (K - 1) x_without, taken as independent.
Interval jackknife(const std::vector<size_t>& all,
                   const std::function<double(const std::vector<size_t>&)>& value) {
    const double whole = value(all);
    const size_t k = all.size();
    if (k < 2) return {whole, unknown_number, unknown_number};
    std::vector<double> pseudo;
    for (size_t left_out = 0; left_out < k; ++left_out) {
        std::vector<size_t> some = all;
        some.erase(some.begin() + static_cast<std::ptrdiff_t>(left_out));
        pseudo.push_back(double(k) * whole - double(k - 1) * value(some));
    }
    const MeanInterval m = mean_interval(pseudo, confidence);
    const double half = m.upper - m.mean;
    return {whole, whole - half, whole + half};
}

std::vector<size_t> numbers(size_t n) {
    std::vector<size_t> v(n);
    for (size_t i = 0; i < n; ++i) v[i] = i;
    return v;
}

double slope_of(const std::vector<double>& x, const std::vector<double>& y) {
    double mx = 0, my = 0, xx = 0, xy = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        mx += x[i] / double(x.size());
        my += y[i] / double(x.size());
    }
    for (size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mx) * (x[i] - mx);
        xy += (x[i] - mx) * (y[i] - my);
    }
    return xx > 0 ? xy / xx : unknown_number;
}

}  // namespace

void leave_out_short_seeds(ConvergenceRun& run) {
    // How far each seed went with all techniques.
    std::vector<double> seconds;
    for (const TechniqueRun& t : run.techniques)
        seconds.resize(std::max(seconds.size(), t.seeds.size()),
                       std::numeric_limits<double>::infinity());
    for (size_t i = 0; i < seconds.size(); ++i)
        for (const TechniqueRun& t : run.techniques)
            seconds[i] = i < t.seeds.size() ? std::min(seconds[i], t.seeds[i].seconds) : 0;
    if (seconds.size() < 2) return;
    std::vector<double> sorted = seconds;
    std::ranges::sort(sorted);
    const double median = sorted[sorted.size() / 2];
    for (TechniqueRun& t : run.techniques)
        for (size_t i = 0; i < t.seeds.size(); ++i)
            t.seeds[i].curve.counts = seconds[i] >= 0.5 * median;
}

std::vector<BandPoint> mean_curve(std::span<const ErrorCurve> all) {
    const std::vector<const ErrorCurve*> curves = with_a_say(all);
    std::vector<BandPoint> band;
    for (const double t : common_times(curves)) {
        BandPoint p;
        p.seconds = t;
        p.cpu_seconds =
            mean_over(curves, [&](const ErrorCurve& c) { return growing_at(c, cpu_of, t); });
        p.spp = mean_over(curves, [&](const ErrorCurve& c) { return growing_at(c, spp_of, t); });
        p.relmse = band_of(curves, relmse_of, t);
        p.relmse_trimmed = band_of(curves, trimmed_of, t);
        p.mse = band_of(curves, mse_of, t);
        p.smape = band_of(curves, smape_of, t);
        band.push_back(p);
    }
    return band;
}

ConvergenceFit fit_slope(std::span<const ErrorCurve> all, double floor) {
    const std::vector<const ErrorCurve*> curves = with_a_say(all);
    const double least = floor > 0 ? floor : 0;
    std::vector<double> times;
    for (const double t : common_times(curves))
        if (mean_over(curves, [&](const ErrorCurve& c) { return error_at(c, relmse_of, t); }) >
            least)
            times.push_back(t);
    ConvergenceFit fit;
    fit.points = int(times.size());
    if (times.size() < 3) return fit;
    const auto slope = [&](const std::vector<size_t>& seeds, bool by_samples) {
        std::vector<const ErrorCurve*> some;
        for (const size_t i : seeds) some.push_back(curves[i]);
        std::vector<double> x, y;
        for (const double t : times) {
            const double error =
                mean_over(some, [&](const ErrorCurve& c) { return error_at(c, relmse_of, t); });
            if (!(error > 0)) continue;
            x.push_back(by_samples ? mean_over(some,
                                               [&](const ErrorCurve& c) {
                                                   return std::log(growing_at(c, spp_of, t));
                                               })
                                   : std::log(t));
            y.push_back(std::log(error));
        }
        return slope_of(x, y);
    };
    const std::vector<size_t> seeds = numbers(curves.size());
    fit.slope = jackknife(seeds, [&](const auto& some) { return slope(some, false); });
    fit.slope_spp = jackknife(seeds, [&](const auto& some) { return slope(some, true); });
    return fit;
}

TimeTo time_to_reach(const std::vector<BandPoint>& band, double relmse) {
    TimeTo result{relmse, {}, false};
    for (size_t i = 0; i < band.size(); ++i) {
        const double error = band[i].relmse.value;
        if (!(error <= relmse)) continue;
        result.at_most = i == 0;
        result.seconds = band[i].seconds;
        if (i == 0) break;
        // Straight in the logarithms, where there are any.
        const double before = band[i - 1].relmse.value, t0 = band[i - 1].seconds;
        if (before > relmse && error > 0)
            result.seconds = t0 * std::pow(band[i].seconds / t0,
                                           std::log(before / relmse) / std::log(before / error));
        break;
    }
    return result;
}

std::vector<double> errors_to_reach(const std::vector<TechniqueResult>& techniques, double floor,
                                    size_t most) {
    double lowest = std::numeric_limits<double>::infinity(), highest = 0;
    for (const TechniqueResult& t : techniques)
        for (const BandPoint& p : t.band)
            if (p.relmse.value > 0) {
                lowest = std::min(lowest, p.relmse.value);
                highest = std::max(highest, p.relmse.value);
            }
    if (floor > lowest) lowest = floor;
    std::vector<double> errors;
    for (int decade = -12; decade <= 12; ++decade)
        for (const double digit : {1.0, 3.0}) {
            const double e =
                decade < 0 ? digit / std::pow(10.0, -decade) : digit * std::pow(10.0, decade);
            if (e >= lowest && e <= highest && errors.size() < most) errors.push_back(e);
        }
    std::reverse(errors.begin(), errors.end());
    return errors;
}

Interval relative_efficiency(std::span<const ErrorCurve> first, std::span<const ErrorCurve> other,
                             EfficiencyMetric metric) {
    const Field field = metric == EfficiencyMetric::relmse ? relmse_of : trimmed_of;
    // Seeds that both have.
    std::vector<double> a, b;
    const auto error_time = [&](const ErrorCurve& c) {
        const double last = c.points.back().seconds;
        double sum = 0;
        int n = 0;
        for (const ErrorPoint& p : c.points)
            if (p.seconds >= 0.5 * last) {
                sum += field(p) * p.seconds;
                ++n;
            }
        return sum / n;
    };
    for (size_t i = 0; i < std::min(first.size(), other.size()); ++i) {
        if (!has_a_say(first[i]) || !has_a_say(other[i])) continue;
        a.push_back(error_time(first[i]));
        b.push_back(error_time(other[i]));
    }
    if (a.empty()) return {};
    const Interval log_ratio = jackknife(numbers(a.size()), [&](const std::vector<size_t>& some) {
        double x = 0, y = 0;
        for (const size_t i : some) {
            x += a[i];
            y += b[i];
        }
        return x > 0 && y > 0 ? std::log(x / y) : unknown_number;
    });
    return {std::exp(log_ratio.value), std::exp(log_ratio.lower), std::exp(log_ratio.upper)};
}

ErrorPoint mean_of_last(std::span<const ErrorCurve> all) {
    ErrorPoint mean;
    const std::vector<const ErrorCurve*> curves = with_a_say(all);
    if (curves.empty()) return mean;
    const auto over = [&](const std::function<double(const ErrorPoint&)>& value) {
        return mean_over(curves, [&](const ErrorCurve& c) { return value(c.points.back()); });
    };
    mean.seconds = over([](const ErrorPoint& p) { return p.seconds; });
    mean.cpu_seconds = over(cpu_of);
    mean.spp = std::uint64_t(std::llround(over(spp_of)));
    mean.mse = over(mse_of);
    mean.rmse = std::sqrt(std::max(0.0, mean.mse));
    mean.relmse = over(relmse_of);
    mean.relmse_trimmed = over(trimmed_of);
    mean.smape = over(smape_of);
    const double flip = over([](const ErrorPoint& p) { return p.flip.value_or(unknown_number); });
    if (!std::isnan(flip)) mean.flip = flip;
    mean.bias = over([](const ErrorPoint& p) { return p.bias; });
    return mean;
}

}  // namespace midway
