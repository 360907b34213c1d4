#include "report/audit_sums.h"

#include <algorithm>
#include <cmath>

namespace midway {

void Deviation::add(double deviation, const AuditPlace& place) {
    double d = std::abs(deviation);
    if (!(d >= 0)) d = std::numeric_limits<double>::infinity();
    size_t bin = 0;
    if (std::isinf(d))
        bin = bins_.size() - 1;
    else if (d > 0)
        bin = static_cast<size_t>(
            std::clamp(std::ceil((std::log10(d) - lowest) * steps), 0.0, double(steps * decades)));
    ++bins_[bin];
    if (count_++ == 0 || d > worst_ || (d == worst_ && place.key() < place_.key())) {
        worst_ = d;
        place_ = place;
    }
}

void Deviation::merge(const Deviation& o) {
    if (o.count_ == 0) return;
    if (count_ == 0 || o.worst_ > worst_ || (o.worst_ == worst_ && o.place_.key() < place_.key())) {
        worst_ = o.worst_;
        place_ = o.place_;
    }
    count_ += o.count_;
    for (size_t i = 0; i < bins_.size(); ++i) bins_[i] += o.bins_[i];
}

double Deviation::quantile(double q) const {
    const double wanted = q * static_cast<double>(count_);
    std::uint64_t below = 0;
    for (size_t i = 0; i < bins_.size(); ++i) {
        below += bins_[i];
        if (below == 0 || static_cast<double>(below) < wanted) continue;
        // Nothing exceeds the worst, though its step of the histogram may end above it.
        return i == 0 ? 0 : std::min(worst_, std::pow(10.0, lowest + double(i) / steps));
    }
    return 0;
}

void Range::add_log(double d) {
    low = std::min(low, d);
    high = std::max(high, d);
}

void Range::add(double value) {
    if (value > 0 && std::isfinite(value)) add_log(std::log10(value));
}

void Range::merge(const Range& o) {
    low = std::min(low, o.low);
    high = std::max(high, o.high);
}

}  // namespace midway
