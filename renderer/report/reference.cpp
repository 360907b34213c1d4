#include "report/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "image/metrics.h"
#include "math/hash.h"
#include "math/student.h"
#include "render/film_file.h"

namespace midway {
namespace {

// Independent means, each of `count` passes; empty halves are left out.
struct Part {
    const Film* film;
    int half;
    double count;

    dvec3 pixel(int x, int y) const {
        const FixedRgb sum = film->sum(half, x, y);
        const int unit = film->unit_exponent();
        return dvec3(from_fixed(sum[0], unit), from_fixed(sum[1], unit), from_fixed(sum[2], unit)) /
               count;
    }
};

std::vector<Part> parts_of(std::span<const FilmPart> films) {
    std::vector<Part> parts;
    for (const FilmPart& f : films) {
        if (f.passes.a > 0) parts.push_back({f.film, 0, double(f.passes.a)});
        if (f.passes.b > 0) parts.push_back({f.film, 1, double(f.passes.b)});
    }
    return parts;
}

// The mean of numbers of weights n_j, whose variance is taken as s^2 / n_j, and its standard error:
// s^2 = sum n_j (x_j - mean)^2 / (J - 1).
MeasuredMean weighted_mean(const std::vector<double>& x, const std::vector<Part>& parts) {
    double n = 0, mean = 0, squares = 0;
    for (size_t j = 0; j < x.size(); ++j) {
        n += parts[j].count;
        mean += parts[j].count * x[j];
    }
    mean /= n;
    for (size_t j = 0; j < x.size(); ++j) squares += parts[j].count * sqr(x[j] - mean);
    const double freedom = double(x.size()) - 1;
    return {{mean, freedom > 0 ? std::sqrt(squares / freedom / n) : 0}, freedom};
}

// As weighted_mean, for each channel of a pixel.
dvec3 pixel_variance(const std::vector<dvec3>& x, const std::vector<Part>& parts, dvec3& mean) {
    double n = 0;
    dvec3 squares(0);
    mean = dvec3(0);
    for (size_t j = 0; j < x.size(); ++j) {
        n += parts[j].count;
        mean += parts[j].count * x[j];
    }
    mean /= n;
    for (size_t j = 0; j < x.size(); ++j) squares += parts[j].count * (x[j] - mean) * (x[j] - mean);
    return x.size() > 1 ? squares / (double(x.size()) - 1) / n : dvec3(0);
}

// The image mean's error from its pixels', taken as independent; the channels of one pixel are
// taken as wholly correlated, which is the worst that they can be.
MeasuredMean luminance_of(const Image& image, const Image& variance) {
    double sum = 0;
    for (const vec3& v : variance.pixels)
        sum += sqr(luminance(dvec3(std::sqrt(v.x), std::sqrt(v.y), std::sqrt(v.z))));
    const double n = double(image.pixels.size());
    return {{mean_luminance(image), std::sqrt(sum) / n}, n};
}

bool is_variance(const Image& v, const Image& image) {
    if (v.width != image.width || v.height != image.height) return false;
    for (const vec3& p : v.pixels)
        if (!is_finite(p) || p.x < 0 || p.y < 0 || p.z < 0) return false;
    return true;
}

// Squared standard error of the mean luminance, and its degrees of freedom: the sum of the squares
// of the blocks' differences, whose freedom follows from how unequal they are (Satterthwaite 1946).
struct SquaredError {
    double value = 0, freedom = 0;
};

SquaredError error_of_mean(const Film& film, const PassCounts& n) {
    constexpr int blocks = 8;
    const Part a{&film, 0, double(n.a)}, b{&film, 1, double(n.b)};
    std::array<double, blocks * blocks> difference{};
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x)
            difference[y * blocks / film.height() * blocks + x * blocks / film.width()] +=
                luminance(a.pixel(x, y) - b.pixel(x, y));
    double squares = 0, fourths = 0;
    for (const double d : difference) {
        squares += d * d;
        fourths += sqr(d * d);
    }
    if (squares == 0) return {};
    const double total = double(n.total());
    const double pixels = double(film.width()) * film.height();
    return {squares * (double(n.a) / total) * (double(n.b) / total) / sqr(pixels),
            std::clamp(3 * sqr(squares) / fourths, 1.0, double(blocks * blocks))};
}

}  // namespace

MeasuredMean film_luminance(const Film& film, const PassCounts& n) {
    const double total = double(n.total());
    double mean = 0;
    if (n.a > 0) mean += double(n.a) / total * half_luminance(film, n, 0);
    if (n.b > 0) mean += double(n.b) / total * half_luminance(film, n, 1);
    if (n.a == 0 || n.b == 0) return {{mean, 0}, 0};
    const SquaredError e = error_of_mean(film, n);
    return {{mean, std::sqrt(e.value)}, e.freedom};
}

double deviate_of_means(const MeasuredMean& x, const MeasuredMean& r) {
    const double own = sqr(x.estimate.standard_error), other = sqr(r.estimate.standard_error);
    if (!(x.freedom > 0) || !(own + other > 0) || r.estimate.mean == 0)
        return std::numeric_limits<double>::quiet_NaN();
    double inverse = sqr(own) / x.freedom;
    if (r.freedom > 0) inverse += sqr(other) / r.freedom;
    return normal_deviate_of_student((x.estimate.mean - r.estimate.mean) / std::sqrt(own + other),
                                     sqr(own + other) / inverse);
}

double mean_luminance(const Image& image) {
    double sum = 0;
    for (const vec3& p : image.pixels) sum += luminance(dvec3(p));
    return image.pixels.empty() ? 0 : sum / double(image.pixels.size());
}

double half_luminance(const Film& film, const PassCounts& passes, int half) {
    const Part part{&film, half, double(half == 0 ? passes.a : passes.b)};
    double sum = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) sum += luminance(part.pixel(x, y));
    return sum / (double(film.width()) * film.height());
}

Reference reference_of_films(std::span<const FilmPart> films) {
    const std::vector<Part> parts = parts_of(films);
    if (parts.empty())
        throw std::runtime_error("no samples (reference); render it for a longer time");
    const int width = parts.front().film->width(), height = parts.front().film->height();
    Reference r;
    r.image = Image(width, height);
    Image variance(width, height);
    std::vector<double> means(parts.size(), 0);
    std::vector<dvec3> values(parts.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            for (size_t j = 0; j < parts.size(); ++j) {
                values[j] = parts[j].pixel(x, y);
                means[j] += luminance(values[j]);
            }
            dvec3 mean;
            variance.at(x, y) = vec3(pixel_variance(values, parts, mean));
            r.image.at(x, y) = vec3(mean);
        }
    for (double& m : means) m /= double(width) * height;
    // Two halves tell too little of how far apart they are by chance.
    r.luminance = films.size() == 1 ? film_luminance(*films[0].film, films[0].passes)
                                    : weighted_mean(means, parts);
    if (parts.size() > 1) r.variance = std::move(variance);
    for (const FilmPart& f : films) r.spp += f.passes.total();
    return r;
}

Reference load_reference(const std::string& path) {
    if (path.ends_with(".film")) {
        const FilmFile file = read_film(path);
        const FilmPart part{&file.films.front(), pass_counts(file.header)};
        return reference_of_films({&part, 1});
    }
    LoadedImage loaded = read_image(path);
    Reference r;
    r.image = std::move(loaded.image);
    r.luminance.estimate.mean = mean_luminance(r.image);
    for (ImageLayer& layer : loaded.layers)
        if (layer.name == "variance" && is_variance(layer.image, r.image)) {
            r.luminance = luminance_of(r.image, layer.image);
            r.variance = std::move(layer.image);
        }
    return r;
}

void check_reference_size(const Reference& r, int width, int height, const std::string& path) {
    if (r.image.width == width && r.image.height == height) return;
    throw std::runtime_error("reference is of another size: " + std::to_string(r.image.width) +
                             "x" + std::to_string(r.image.height) + " (" + path +
                             "); render at its size or give another reference");
}

ReferenceFloor reference_floor(const Reference& r) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    if (!r.variance) return {unknown, unknown, unknown};
    DiffOptions options;
    options.flip = false;
    // An image as far from the reference, in every pixel, as the reference is from the truth.
    Image other = r.image;
    for (size_t i = 0; i < other.pixels.size(); ++i)
        for (int k = 0; k < 3; ++k)
            other.pixels[i][k] +=
                std::copysign(std::sqrt(r.variance->pixels[i][k]), other.pixels[i][k]);
    const double trimmed = compare_images(other, r.image, options).relmse_trimmed;
    options.reference_variance = &*r.variance;
    // The error of the reference against itself: nothing, less its variance.
    const ImageError e = compare_images(r.image, r.image, options);
    return {-e.mse, -e.relmse, trimmed};
}

std::uint64_t reference_hash(const Reference& r) {
    const std::uint64_t size = hash_combine(std::uint64_t(r.image.width), r.image.height);
    const std::uint64_t h = hash_bytes(size, r.image.pixels.data(), r.image.pixels.size() * 12);
    if (!r.variance) return h;
    return hash_bytes(h, r.variance->pixels.data(), r.variance->pixels.size() * 12);
}

}  // namespace midway
