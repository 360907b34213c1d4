#include "image/film.h"

#include <bit>
#include <cmath>
#include <stdexcept>

namespace midway {
namespace {

Int128 join(std::uint64_t low, std::uint64_t high) {
    return static_cast<Int128>((static_cast<UInt128>(high) << 64) | low);
}

// Adds with the carry found by the low word itself, so the pair is exact once all adders are done.
// False where the sum wrapped around.
bool atomic_add(std::uint64_t* word, Int128 v) {
    const auto low = static_cast<std::uint64_t>(v);
    auto high = static_cast<std::uint64_t>(static_cast<UInt128>(v) >> 64);
    const std::uint64_t before = std::atomic_ref(word[0]).fetch_add(low, std::memory_order_relaxed);
    high += before + low < before;
    if (high == 0) return true;
    const std::uint64_t old = std::atomic_ref(word[1]).fetch_add(high, std::memory_order_relaxed);
    const std::uint64_t sum = old + high;
    return ((old ^ sum) & (high ^ sum)) >> 63 == 0;
}

// The unit as a factor: exact, and dearer to apply by ldexp than by a product.
long double unit_factor(int unit_exponent) { return std::ldexp(1.0L, unit_exponent); }

double scaled(Int128 v, long double unit) {
    return static_cast<double>(static_cast<long double>(v) * unit);
}

}  // namespace

int film_unit_exponent(double power) {
    constexpr int bits_below = 90;
    if (!(power > 0)) return -bits_below;
    int exponent = 0;
    std::frexp(power, &exponent);
    return exponent - bits_below;
}

Int128 to_fixed(float v, int unit_exponent, FixedCounts& counts) {
    const auto bits = std::bit_cast<std::uint32_t>(v);
    const int exponent = static_cast<int>((bits >> 23) & 255);
    if (exponent == 0) return 0;  // zero; workers flush denormals
    const std::uint32_t mantissa = (bits & 0x7fffffu) | 0x800000u;
    const int shift = exponent - 150 - unit_exponent;
    Int128 fixed;
    if (shift >= 0) {
        // Room for the contributions of one sample to be summed before they reach the film.
        if (shift > 96) {
            ++counts.overflow;
            return 0;
        }
        fixed = static_cast<Int128>(mantissa) << shift;
    } else if (shift < -24) {
        ++counts.inexact;
        return 0;
    } else {
        const std::uint32_t lost = mantissa & ((1u << -shift) - 1);
        counts.inexact += lost != 0;
        fixed = (mantissa + (1u << (-shift - 1))) >> -shift;
    }
    return bits >> 31 ? -fixed : fixed;
}

double from_fixed(Int128 v, int unit_exponent) { return scaled(v, unit_factor(unit_exponent)); }

Film::Film(int width, int height, int unit_exponent)
    : width_(width),
      height_(height),
      unit_exponent_(unit_exponent),
      words_(static_cast<size_t>(width) * height * 12) {}

bool Film::add(int half, int x, int y, const FixedRgb& value) {
    std::uint64_t* word = &words_[place(half, x, y)];
    bool fits = true;
    for (int c = 0; c < 3; ++c)
        if (value[c] != 0) fits &= atomic_add(word + 2 * c, value[c]);
    return fits;
}

FixedRgb Film::sum(int half, int x, int y) const {
    const std::uint64_t* word = &words_[place(half, x, y)];
    return {join(word[0], word[1]), join(word[2], word[3]), join(word[4], word[5])};
}

void Film::merge(const Film& other) {
    if (other.width_ != width_ || other.height_ != height_ ||
        other.unit_exponent_ != unit_exponent_)
        throw std::runtime_error(
            "films differ in size or unit (merge); merge films of one scene and one size");
    for (size_t i = 0; i < words_.size(); i += 2) {
        Int128 sum = 0;
        if (__builtin_add_overflow(join(words_[i], words_[i + 1]),
                                   join(other.words_[i], other.words_[i + 1]), &sum))
            throw std::runtime_error(
                "sum of two films leaves its range (merge); the films are damaged");
        words_[i] = static_cast<std::uint64_t>(sum);
        words_[i + 1] = static_cast<std::uint64_t>(static_cast<UInt128>(sum) >> 64);
    }
}

PassCounts pass_counts(std::uint64_t first, std::uint64_t end) {
    const auto even_below = [](std::uint64_t n) { return (n + 1) / 2; };
    const std::uint64_t a = even_below(end) - even_below(first);
    return {a, end - first - a};
}

void resolve_rows(const Film& film, const PassCounts& passes, int y0, int y1, Image* mean,
                  Image* variance) {
    const long double unit = unit_factor(film.unit_exponent());
    const double n = static_cast<double>(passes.total());
    if (passes.a == 0 || passes.b == 0) variance = nullptr;
    for (int y = y0; y < y1; ++y)
        for (int x = 0; x < film.width(); ++x) {
            const FixedRgb a = film.sum(0, x, y), b = film.sum(1, x, y);
            for (int c = 0; c < 3; ++c) {
                if (mean) {
                    // A damaged film may hold any bits: its halves are added modulo 2^128.
                    const auto sum = static_cast<Int128>(static_cast<UInt128>(a[c]) +
                                                         static_cast<UInt128>(b[c]));
                    mean->at(x, y)[c] = n > 0 ? static_cast<float>(scaled(sum, unit) / n) : 0.0f;
                }
                if (variance) {
                    const double difference = scaled(a[c], unit) / double(passes.a) -
                                              scaled(b[c], unit) / double(passes.b);
                    variance->at(x, y)[c] = static_cast<float>(0.25 * difference * difference);
                }
            }
        }
}

Image resolve(const Film& film, const PassCounts& passes) {
    Image mean(film.width(), film.height());
    resolve_rows(film, passes, 0, film.height(), &mean, nullptr);
    return mean;
}

Image resolve_variance(const Film& film, const PassCounts& passes) {
    Image variance(film.width(), film.height());
    resolve_rows(film, passes, 0, film.height(), nullptr, &variance);
    return variance;
}

}  // namespace midway
