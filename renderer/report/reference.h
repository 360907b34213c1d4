// The image that errors are measured against, and what is known of its own error. A reference of
// several independent parts (the halves A and B of films of one or more seeds) knows the variance
// of its pixels and of its mean from the spread of the parts; one without parts is taken as exact.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/film.h"
#include "math/statistics.h"

namespace midway {

// An estimate with the degrees of freedom that its standard error was measured with.
struct MeasuredMean {
    Estimate estimate;
    double freedom = 0;  // 0: nothing is known of the error
};

struct Reference {
    Image image;
    std::optional<Image> variance;  // of each pixel
    MeasuredMean luminance;         // of the whole image
    std::uint64_t spp = 0;          // 0: unknown
};

struct FilmPart {
    const Film* film = nullptr;
    PassCounts passes;
};

// Mean luminance of a film. Its error comes from the difference of the halves A and B, block by
// block of an 8 x 8 grid, with blocks taken as independent; unknown where one half is empty.
MeasuredMean film_luminance(const Film& film, const PassCounts& passes);

// The difference of two means in standard errors, as a normal deviate (Welch 1947); NaN where the
// error of `x` is not known. A reference of unknown error is taken as exact.
double deviate_of_means(const MeasuredMean& x, const MeasuredMean& reference);

// The mean of films of one scene and size that differ in their seeds.
Reference reference_of_films(std::span<const FilmPart> films);

// A .film, or an image: an EXR's layer "variance" (as `midway render --aov` and `midway compare`
// write it) tells its error, with pixels taken as independent. Throws std::runtime_error.
Reference load_reference(const std::string& path);

// Throws std::runtime_error where the reference is of another size.
void check_reference_size(const Reference& reference, int width, int height,
                          const std::string& path);

// The reference's own mse and relmse; NaN where unknown. Trimmed: without the pixels of the largest
// variance (a curve loses those where technique and reference differ most).
struct ReferenceFloor {
    double mse = 0, relmse = 0, relmse_trimmed = 0;
};
ReferenceFloor reference_floor(const Reference& reference);

// Mean luminance (Rec. 709) of an image, in double.
double mean_luminance(const Image& image);

// Mean luminance of one half (0: A, 1: B) of a film.
double half_luminance(const Film& film, const PassCounts& passes, int half);

// Hash of the pixels, to tell references apart.
std::uint64_t reference_hash(const Reference& reference);

}  // namespace midway
