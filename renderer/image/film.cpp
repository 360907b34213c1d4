#include "image/film.h"

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace midway {
namespace {

Int128 join(std::uint64_t low, std::uint64_t high) {
    return static_cast<Int128>((static_cast<UInt128>(high) << 64) | low);
}

// Waits until nobody else adds to a pixel; others wait until it is destroyed.
class PixelLock {
  public:
    explicit PixelLock(std::uint8_t& busy) : busy_(busy) {
        while (busy_.exchange(1, std::memory_order_acquire) != 0) std::this_thread::yield();
    }
    ~PixelLock() { busy_.store(0, std::memory_order_release); }
    PixelLock(const PixelLock&) = delete;
    PixelLock& operator=(const PixelLock&) = delete;

  private:
    std::atomic_ref<std::uint8_t> busy_;
};

void store(Int128 v, std::uint64_t* word) {
    word[0] = static_cast<std::uint64_t>(v);
    word[1] = static_cast<std::uint64_t>(static_cast<UInt128>(v) >> 64);
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

Int128 to_fixed_at_the_edge(float v, int unit_exponent, FixedCounts& counts) {
    const auto bits = std::bit_cast<std::uint32_t>(v);
    const int exponent = static_cast<int>((bits >> 23) & 255);
    if (exponent == 0) return 0;                      // zero; workers flush denormals
    const int lost = 150 + unit_exponent - exponent;  // bits below the unit
    if (lost <= 0) {
        ++counts.overflow;
        return 0;
    }
    if (lost > 24) {
        ++counts.inexact;
        return 0;
    }
    const std::uint32_t mantissa = (bits & 0x7fffffu) | 0x800000u;
    counts.inexact += (mantissa & ((1u << lost) - 1)) != 0;
    const Int128 fixed = (mantissa + (1u << (lost - 1))) >> lost;
    return bits >> 31 ? -fixed : fixed;
}

double from_fixed(Int128 v, int unit_exponent) { return scaled(v, unit_factor(unit_exponent)); }

bool add_to(const FilmPlace& place, const FixedRgb& value) {
    bool fits = true;
    const PixelLock lock(*place.busy);
    for (int c = 0; c < 3; ++c) {
        std::uint64_t* word = place.words + 2 * c;
        Int128 sum = 0;
        fits &= !__builtin_add_overflow(join(word[0], word[1]), value[c], &sum);
        store(sum, word);
    }
    return fits;
}

Film::Film(int width, int height, int unit_exponent)
    : width_(width),
      height_(height),
      unit_exponent_(unit_exponent),
      words_(static_cast<size_t>(width) * height * 12),
      busy_(static_cast<size_t>(width) * height) {}

FixedRgb Film::sum(int half, int x, int y) const {
    const std::uint64_t* word = &words_[this->word(half, x, y)];
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
        store(sum, &words_[i]);
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
