#include "error_watch.h"

#include <algorithm>

#include "image/file.h"
#include "render_options.h"

namespace midway {

void add_error_options(CLI::App& sub, ErrorOptions& o) {
    sub.add_option("--reference", o.reference,
                   "EXR, HDR or .film that errors are measured against; an EXR's layer "
                   "\"variance\" or a film's halves tell its own error, which is subtracted");
    sub.add_option("--error-log", o.log,
                   "Errors while rendering, as CSV: at every pass up to 8, then four times in each "
                   "doubling (needs --reference)");
    sub.add_option("--target-error", o.target,
                   "Stop at this relMSE: against --reference, or else as estimated from the halves "
                   "A and B of the samples; looked at where --error-log looks, so that the same "
                   "command always stops at the same sample")
        ->check(positive_number());
}

void check_error_options(const ErrorOptions& o, bool resume) {
    if (o.log && !o.reference) usage("--error-log: needs --reference");
    if (o.reference && !o.log && !o.target)
        usage("--reference: nothing uses it; give --error-log or --target-error");
    if (o.log && resume) usage("--resume: an error log is not in a checkpoint");
}

ErrorWatch::ErrorWatch(const ErrorOptions& options, const RenderSettings& settings)
    : options_(options), settings_(settings) {
    if (!options.reference) return;
    reference_ = load_reference(*options.reference);
    const PixelRect all{0, 0, settings.width, settings.height};
    const PixelRect crop = settings.crop.value_or(all);
    check_reference_size(*reference_, crop.width(), crop.height(), *options.reference);
}

std::uint64_t ErrorWatch::next(const ProgressiveRenderer& r) const {
    return next_measured_pass(r.passes());
}

void ErrorWatch::take(const ProgressiveRenderer& r, double seconds) {
    const std::uint64_t n = r.passes();
    if (n == 0 || n == taken_) return;
    taken_ = n;
    if (!reference_) {
        error_ = estimate_relmse(r.film(), r.counts());
    } else {
        for (size_t i = 0; i < settings_.exponents.size(); ++i) {
            const ErrorPoint p =
                measure_error(*reference_, r.film(static_cast<int>(i)), r.counts(),
                              {before_.seconds + seconds, before_.cpu_seconds + r.cpu_seconds()});
            if (i == 0) error_ = p.relmse;
            rows_ += error_csv_row(std::string(to_string(settings_.technique)),
                                   settings_.exponents[i], settings_.seed, p);
        }
        if (options_.log) atomic_write(*options_.log, rows_);
    }
    // Where time ran out between two of the numbers that count, nothing is decided.
    if (options_.target && next_measured_pass(n - 1) == n) reached_ = error_ <= *options_.target;
}

double ErrorWatch::share() const {
    if (!options_.target || !(error_ > 0)) return 0;
    return std::min(1.0, *options_.target / error_);
}

}  // namespace midway
