// The film: exact sums of contributions. Every value is a 128-bit integer in units of 2^-90 of a
// power of two near the scene's emitted power, so sums do not depend on their order: not on
// threads, nor on being split over runs or machines. Float contributions are held exactly over some
// 30 decades; what loses bits below or does not fit above is counted. Even passes go to half A, odd
// ones to half B.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "image/image.h"
#include "math/huge_pages.h"

namespace midway {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 UInt128;
using FixedRgb = std::array<Int128, 3>;

// The power of two that one unit of a film stands for; `power` is the scene's (0: any).
int film_unit_exponent(double power);

struct FixedCounts {
    std::uint64_t inexact = 0;   // bits below the unit were rounded
    std::uint64_t overflow = 0;  // did not fit and was not added
};

// Of to_fixed(): zero, what has bits below the unit, and what does not fit.
Int128 to_fixed_at_the_edge(float v, int unit_exponent, FixedCounts& counts);

// v in units of 2^unit_exponent, rounded to nearest. v is finite.
inline Int128 to_fixed(float v, int unit_exponent, FixedCounts& counts) {
    const auto bits = std::bit_cast<std::uint32_t>(v);
    const int exponent = static_cast<int>((bits >> 23) & 255);
    const int shift = exponent - 150 - unit_exponent;
    // The upper end leaves room for the contributions of one sample to be summed before they reach
    // the film.
    if (exponent == 0 || shift < 0 || shift > 96)
        return to_fixed_at_the_edge(v, unit_exponent, counts);
    const Int128 fixed = static_cast<Int128>((bits & 0x7fffffu) | 0x800000u) << shift;
    return bits >> 31 ? -fixed : fixed;
}
double from_fixed(Int128 v, int unit_exponent);

// Memory that is zero when it is first touched, so that a large film is made at once: for vectors
// that are given their size when they are made and never grow.
template <class T>
struct ZeroedAllocator {
    using value_type = T;
    ZeroedAllocator() = default;
    template <class U>
    ZeroedAllocator(const ZeroedAllocator<U>&) {}
    T* allocate(size_t n) {
        if (n > std::numeric_limits<size_t>::max() / sizeof(T)) throw std::bad_alloc();
        void* p = std::calloc(n, sizeof(T));
        if (!p) throw std::bad_alloc();
        ask_for_huge_pages(p, n * sizeof(T));
        return static_cast<T*>(p);
    }
    void deallocate(T* p, size_t) { std::free(p); }
    template <class U>
    void construct(U*) {}
    template <class U, class V>
    void construct(U* p, const V& v) {
        *p = v;
    }
    bool operator==(const ZeroedAllocator&) const { return true; }
};
using FilmWords = std::vector<std::uint64_t, ZeroedAllocator<std::uint64_t>>;

// Where one half of a pixel is kept.
struct FilmPlace {
    std::uint64_t* words = nullptr;
    std::uint8_t* busy = nullptr;  // 1 while somebody adds
};

// Safe from many threads at once. False where a sum left 128 bits: the pixel is lost, and the
// caller counts it.
[[nodiscard]] bool add_to(const FilmPlace& place, const FixedRgb& value);

// Asks the memory for what add_to() will touch: without it most of a splat's time is one miss.
inline void prefetch(const FilmPlace& place) {
    __builtin_prefetch(place.words, 1);
    __builtin_prefetch(place.words + 5, 1);
    __builtin_prefetch(place.busy, 1);
}

class Film {
  public:
    Film(int width, int height, int unit_exponent);

    int width() const { return width_; }
    int height() const { return height_; }
    int unit_exponent() const { return unit_exponent_; }

    FilmPlace place(int half, int x, int y) {
        return {&words_[word(half, x, y)], &busy_[pixel(x, y)]};
    }

    // As add_to().
    [[nodiscard]] bool add(int half, int x, int y, const FixedRgb& value) {
        return add_to(place(half, x, y), value);
    }

    // The sums of one half of a pixel; call when nobody adds.
    FixedRgb sum(int half, int x, int y) const;

    // Throws where size or unit differ, or a sum leaves 128 bits.
    void merge(const Film& other);

    // Raw words for a file: for every pixel, half and channel the low and the high 64 bits.
    const FilmWords& words() const { return words_; }
    FilmWords& words() { return words_; }

  private:
    size_t pixel(int x, int y) const { return static_cast<size_t>(y) * width_ + x; }
    size_t word(int half, int x, int y) const { return (pixel(x, y) * 2 + half) * 6; }
    int width_, height_, unit_exponent_;
    FilmWords words_;
    // For each pixel: one atomic operation guards its six words.
    std::vector<std::uint8_t, ZeroedAllocator<std::uint8_t>> busy_;
};

// How many passes each half holds: passes [0, n) put (n + 1) / 2 into A.
struct PassCounts {
    std::uint64_t a = 0, b = 0;
    std::uint64_t total() const { return a + b; }
};
PassCounts pass_counts(std::uint64_t first, std::uint64_t end);

// The mean of all passes.
Image resolve(const Film& film, const PassCounts& passes);

// Estimated variance of resolve()'s pixels: a quarter of the squared difference of the halves'
// means.
Image resolve_variance(const Film& film, const PassCounts& passes);

// Rows y0 to y1 (excluded) of either, or of both at once (the other null), into images of the
// film's size; so that many threads may share the work. No variance where a half holds nothing.
void resolve_rows(const Film& film, const PassCounts& passes, int y0, int y1, Image* mean,
                  Image* variance);

}  // namespace midway
