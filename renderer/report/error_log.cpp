#include "report/error_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "image/metrics.h"

namespace midway {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

dvec3 half_mean(const Film& film, int half, std::uint64_t count, int x, int y) {
    const FixedRgb sum = film.sum(half, x, y);
    const int unit = film.unit_exponent();
    return dvec3(from_fixed(sum[0], unit), from_fixed(sum[1], unit), from_fixed(sum[2], unit)) /
           double(count);
}

// The shortest text that reads back as the same bits; nothing where the number is unknown.
std::string number_text(double v) { return std::isnan(v) ? "" : fmt::format("{}", v); }

}  // namespace

ErrorPoint measure_error(const Reference& r, const Image& image, std::uint64_t spp,
                         const Elapsed& elapsed, bool flip) {
    DiffOptions options;
    options.flip = flip;
    if (r.variance) options.reference_variance = &*r.variance;
    const ImageError e = compare_images(image, r.image, options);
    ErrorPoint p{elapsed.seconds, elapsed.cpu_seconds, spp};
    p.mse = e.mse;
    p.rmse = e.rmse;
    p.relmse = e.relmse;
    p.relmse_trimmed = e.relmse_trimmed;
    p.smape = e.smape;
    if (flip) p.flip = e.flip;
    p.bias = bias(e);
    p.bias_z = unknown;
    return p;
}

ErrorPoint measure_error(const Reference& r, const Film& film, const PassCounts& passes,
                         const Elapsed& elapsed, bool flip) {
    ErrorPoint p = measure_error(r, resolve(film, passes), passes.total(), elapsed, flip);
    p.bias_z = deviate_of_means(film_luminance(film, passes), r.luminance);
    return p;
}

double estimate_relmse(const Film& film, const PassCounts& n) {
    if (n.a == 0 || n.b == 0) return std::numeric_limits<double>::infinity();
    const Image image = resolve(film, n);
    const double total = double(n.total());
    const double share = (double(n.a) / total) * (double(n.b) / total);
    const double epsilon = 0.01 * sqr(mean_luminance(image));
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const dvec3 a = half_mean(film, 0, n.a, x, y), b = half_mean(film, 1, n.b, x, y);
            for (int c = 0; c < 3; ++c)
                if (a[c] != b[c])
                    sum += share * sqr(a[c] - b[c]) / (std::max(0.0, a[c] * b[c]) + epsilon);
        }
    return sum / (3 * double(image.width) * image.height);
}

std::optional<double> estimate_relmse(const Image& mean, const Image& variance,
                                      const PassCounts& passes, size_t step) {
    const size_t size = mean.pixels.size();
    if (passes.a == 0 || passes.a != passes.b || size == 0 || variance.pixels.size() != size)
        return {};
    double light = 0, sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < size; i += step, ++count) light += luminance(dvec3(mean.pixels[i]));
    const double epsilon = 0.01 * sqr(light / double(count));
    for (size_t i = 0; i < size; i += step)
        for (int c = 0; c < 3; ++c) {
            // v = (a - b)^2 / 4 and a b = mean^2 - v.
            const double v = variance.pixels[i][c];
            if (v > 0) sum += v / (std::max(0.0, sqr(double(mean.pixels[i][c])) - v) + epsilon);
        }
    return sum / (3 * double(count));
}

std::uint64_t next_measured_pass(std::uint64_t passes) {
    const std::uint64_t step = std::max<std::uint64_t>(1, std::bit_floor(passes) / 4);
    return (passes / step + 1) * step;
}

std::string error_csv_header() {
    return "technique,exponent,seed,seconds,cpu_seconds,spp,mse,rmse,relmse,relmse_trimmed,smape,"
           "bias,bias_z\n";
}

std::string error_csv_row(const std::string& technique, double exponent, std::uint64_t seed,
                          const ErrorPoint& p) {
    std::string row = fmt::format("{},{},{}", technique, exponent, seed);
    for (const double v : {p.seconds, p.cpu_seconds}) row += "," + number_text(v);
    row += fmt::format(",{}", p.spp);
    for (const double v : {p.mse, p.rmse, p.relmse, p.relmse_trimmed, p.smape, p.bias, p.bias_z})
        row += "," + number_text(v);
    return row + "\n";
}

}  // namespace midway
