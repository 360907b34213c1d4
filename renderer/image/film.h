// The film: exact sums of contributions. Every value is a 128-bit integer in units of 2^-90 of a
// power of two near the scene's emitted power, so sums do not depend on their order: not on
// threads, nor on being split over runs or machines. Float contributions are held exactly over some
// 30 decades; what loses bits below or does not fit above is counted. Even passes go to half A, odd
// ones to half B.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "image/image.h"

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

// v in units of 2^unit_exponent, rounded to nearest. v is finite.
Int128 to_fixed(float v, int unit_exponent, FixedCounts& counts);
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

class Film {
  public:
    Film(int width, int height, int unit_exponent);

    int width() const { return width_; }
    int height() const { return height_; }
    int unit_exponent() const { return unit_exponent_; }

    // Safe from many threads at once. False where a sum left 128 bits: the pixel is lost, and the
    // caller counts it.
    [[nodiscard]] bool add(int half, int x, int y, const FixedRgb& value);

    // Asks the memory for what add() will touch: without it most of a splat's time is one miss.
    void prefetch(int half, int x, int y) const {
        const std::uint64_t* word = &words_[place(half, x, y)];
        __builtin_prefetch(word, 1);
        __builtin_prefetch(word + 5, 1);
    }

    // The sums of one half of a pixel; call when nobody adds.
    FixedRgb sum(int half, int x, int y) const;

    // Throws where size or unit differ, or a sum leaves 128 bits.
    void merge(const Film& other);

    // Raw words for a file: for every pixel, half and channel the low and the high 64 bits.
    const FilmWords& words() const { return words_; }
    FilmWords& words() { return words_; }

  private:
    size_t place(int half, int x, int y) const {
        return ((static_cast<size_t>(y) * width_ + x) * 2 + half) * 6;
    }
    int width_, height_, unit_exponent_;
    FilmWords words_;
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
