#include "image/metrics.h"

#include <limits>
#include <stdexcept>

#include "image/flip.h"

namespace midway {
namespace {

std::string size_text(const Image& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
}

void check_size(const Image& image, const Image& reference, const std::string& name) {
    if (image.width != reference.width || image.height != reference.height ||
        image.pixels.size() != reference.pixels.size())
        throw std::runtime_error("cannot compare images: sizes differ (" + name + " " +
                                 size_text(image) + ", reference " + size_text(reference) +
                                 "); give images of one size");
}

void check_finite(const Image& image, size_t index, const std::string& name) {
    if (is_finite(image.pixels[index])) return;
    const size_t width = static_cast<size_t>(image.width);
    throw std::runtime_error("cannot compare images: a pixel is not finite (" + name + ", pixel " +
                             std::to_string(index % width) + "," + std::to_string(index / width) +
                             "); render it again or leave the pixel out by a mask");
}

// Indices of the pixels that count, all of them finite.
std::vector<size_t> counted_pixels(const Image& test, const Image& reference,
                                   const DiffOptions& options) {
    check_size(test, reference, "image");
    if (options.mask) check_size(*options.mask, reference, "mask");
    if (options.reference_variance)
        check_size(*options.reference_variance, reference, "variance of the reference");
    if (options.epsilon && !(*options.epsilon >= 0 && std::isfinite(*options.epsilon)))
        throw std::runtime_error("cannot compare images: wrong epsilon (" +
                                 std::to_string(*options.epsilon) +
                                 "); give a finite number that is not negative");
    std::vector<size_t> counted;
    for (size_t i = 0; i < reference.pixels.size(); ++i) {
        if (options.mask) {
            check_finite(*options.mask, i, "mask");
            if (is_black(options.mask->pixels[i])) continue;
        }
        check_finite(test, i, "image");
        check_finite(reference, i, "reference");
        if (options.reference_variance)
            check_finite(*options.reference_variance, i, "variance of the reference");
        counted.push_back(i);
    }
    if (counted.empty())
        throw std::runtime_error("cannot compare images: no pixel counts (" + size_text(reference) +
                                 "); give images with pixels and a mask that is not all black");
    return counted;
}

double quotient(double numerator, double denominator) {
    return numerator == 0 ? 0 : numerator / denominator;
}

double mean_luminance(const Image& image, const std::vector<size_t>& counted) {
    double sum = 0;
    for (size_t i : counted) sum += luminance(dvec3(image.pixels[i]));
    return sum / static_cast<double>(counted.size());
}

// Mean of `values` without those whose `keys` are the largest 0.1 %, summed in the given order. Of
// keys equal to the largest one kept, the first stay.
double trimmed_mean(const std::vector<double>& keys, const std::vector<double>& values) {
    const size_t kept = keys.size() - keys.size() / 1000;
    std::vector<double> sorted = keys;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(kept - 1),
                     sorted.end());
    const double limit = sorted[kept - 1];
    size_t equal = kept;
    for (double k : keys)
        if (k < limit) --equal;
    double sum = 0;
    for (size_t i = 0; i < keys.size(); ++i) {
        if (keys[i] > limit || (keys[i] == limit && equal == 0)) continue;
        if (keys[i] == limit) --equal;
        sum += values[i];
    }
    return sum / static_cast<double>(kept);
}

}  // namespace

ImageError compare_images(const Image& test, const Image& reference, const DiffOptions& options) {
    const std::vector<size_t> counted = counted_pixels(test, reference, options);
    const double count = static_cast<double>(counted.size());
    const double test_mean = mean_luminance(test, counted);
    const double reference_mean = mean_luminance(reference, counted);
    const double epsilon = options.epsilon.value_or(0.01 * sqr(reference_mean));

    ImageError error;
    std::vector<double> bare, relative;  // with and without the reference's variance
    bare.reserve(counted.size());
    relative.reserve(counted.size());
    double relative_sum = 0;
    for (size_t i : counted) {
        double pixel = 0, noise = 0;
        for (int c = 0; c < 3; ++c) {
            const double x = test.pixels[i][c], r = reference.pixels[i][c];
            const double square = sqr(x - r);
            const double v =
                options.reference_variance ? options.reference_variance->pixels[i][c] : 0;
            error.mse += square - v;
            pixel += quotient(square, r * r + epsilon);
            noise += quotient(v, r * r + epsilon);
            error.smape += quotient(std::abs(x - r), std::abs(x) + std::abs(r));
        }
        bare.push_back(pixel / 3);
        relative.push_back((pixel - noise) / 3);
        relative_sum += relative.back();
    }
    error.mse /= 3 * count;
    error.rmse = std::sqrt(std::max(0.0, error.mse));
    error.smape /= 3 * count;
    error.relmse = relative_sum / count;
    error.relmse_trimmed = trimmed_mean(bare, relative);
    if (test_mean != 0 || reference_mean != 0) error.mean_ratio = test_mean / reference_mean;
    if (options.flip) {
        const std::vector<float> map = flip_map(test, reference);
        for (size_t i : counted) error.flip += map[i];
        error.flip /= count;
    }
    return error;
}

}  // namespace midway
