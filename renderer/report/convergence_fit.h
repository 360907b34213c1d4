// What curves of several seeds say: mean curve with its band, slope, time to an error, efficiency.
// The points of one curve are correlated (each image goes on from the one before), so residuals of
// a fit say nothing about its error: every interval comes from the spread between seeds, by
// Student's t for means and by the jackknife (Quenouille 1956, Tukey 1958) for what is computed
// from the mean curve. With one seed the intervals are unknown.
#pragma once

#include <span>
#include <vector>

#include "report/comparison.h"
#include "report/convergence.h"

namespace midway {

// A run that was stopped in the middle of a seed leaves curves that end early: where a seed of any
// technique went less than half as far as the (upper) median seed, the curves of that seed no
// longer count, so that what the others know is not cut to its length.
void leave_out_short_seeds(ConvergenceRun& run);

// Mean over the seeds at the times (common to all seeds) from the first to the last; values between
// two points of a curve are interpolated as error x time over log time. Bounds are the mean times
// exp(-+ t standard error / mean), so that they stay positive. Curves that have no points or
// do not count are left out, here and below.
std::vector<BandPoint> mean_curve(std::span<const ErrorCurve> curves);

// Least squares of log relMSE of the mean curve against log time and log samples, over the points
// above the floor (0: all above zero); three points at least.
ConvergenceFit fit_slope(std::span<const ErrorCurve> curves, double floor);

TimeTo time_to_reach(const std::vector<BandPoint>& band, double relmse);

// Errors 1, 3, 10, 30 ... times a power of ten that lie between the curves' ends and above the
// floor (as above): the `most` lowest.
std::vector<double> errors_to_reach(const std::vector<TechniqueResult>& techniques, double floor,
                                    size_t most);

enum class EfficiencyMetric { relmse, relmse_trimmed };

// (mean over seeds of relMSE x seconds over the last doubling of time) of `first` over that of
// `other`. Seeds are taken in pairs, as they took turns; the interval is a jackknife's of the
// logarithm.
Interval relative_efficiency(std::span<const ErrorCurve> first, std::span<const ErrorCurve> other,
                             EfficiencyMetric metric);

// Mean of the last points.
ErrorPoint mean_of_last(std::span<const ErrorCurve> curves);

}  // namespace midway
