// Eight numbers side by side, one for each sample of a group: what the renderer does for eight
// samples at once (integrator/estimator_lanes.h). Every operation is the scalar one in each lane,
// rounded alike and in the same order as GLM's, so that eight samples at once have the bits of each
// alone. Masks say which lanes a result holds for; the others hold anything.
#pragma once

#include <immintrin.h>

#include <bit>

#include "math/vector.h"

namespace midway {

inline constexpr int lane_count = 8;

typedef float Float8 __attribute__((vector_size(32)));
typedef std::int32_t Mask8 __attribute__((vector_size(32)));  // -1: yes, 0: no

// In two halves of the widest registers that all processors here have.
typedef double Double4 __attribute__((vector_size(32)));
typedef std::int64_t Mask4 __attribute__((vector_size(32)));
struct Double8 {
    Double4 low, high;

    friend Double8 operator+(const Double8& a, const Double8& b) {
        return {a.low + b.low, a.high + b.high};
    }
    friend Double8 operator-(const Double8& a, const Double8& b) {
        return {a.low - b.low, a.high - b.high};
    }
    friend Double8 operator*(const Double8& a, const Double8& b) {
        return {a.low * b.low, a.high * b.high};
    }
    friend Double8 operator/(const Double8& a, const Double8& b) {
        return {a.low / b.low, a.high / b.high};
    }
    double operator[](int lane) const { return lane < 4 ? low[lane] : high[lane - 4]; }
    void set(int lane, double x) {
        if (lane < 4)
            low[lane] = x;
        else
            high[lane - 4] = x;
    }
};

inline Double8 all_lanes(double x) { return {x - Double4{}, x - Double4{}}; }
inline Float8 all_lanes(float x) { return x - Float8{}; }

inline constexpr Mask8 no_lane{};
inline constexpr Mask8 every_lane = ~no_lane;

// One bit a lane.
inline unsigned bits(const Mask8& m) {
#ifdef __AVX__
    return static_cast<unsigned>(_mm256_movemask_ps(std::bit_cast<__m256>(m)));
#else
    unsigned b = 0;
    for (int k = 0; k < lane_count; ++k) b |= (m[k] != 0 ? 1u : 0u) << k;
    return b;
#endif
}
inline bool any(const Mask8& m) { return bits(m) != 0; }

// Calls `use` with the number of every lane of the mask, in their order.
template <class Use>
void for_each_lane(const Mask8& m, const Use& use) {
    for (unsigned b = bits(m); b != 0; b &= b - 1) use(std::countr_zero(b));
}

inline Float8 select(const Mask8& m, const Float8& yes, const Float8& no) { return m ? yes : no; }
inline float select(bool m, float yes, float no) { return m ? yes : no; }
inline double select(bool m, double yes, double no) { return m ? yes : no; }

inline Mask4 lower_half(const Mask8& m) {
    return __builtin_convertvector(__builtin_shufflevector(m, m, 0, 1, 2, 3), Mask4);
}
inline Mask4 upper_half(const Mask8& m) {
    return __builtin_convertvector(__builtin_shufflevector(m, m, 4, 5, 6, 7), Mask4);
}
inline Double8 select(const Mask8& m, const Double8& yes, const Double8& no) {
    return {lower_half(m) ? yes.low : no.low, upper_half(m) ? yes.high : no.high};
}

inline Double8 to_double(const Float8& x) {
    return {__builtin_convertvector(__builtin_shufflevector(x, x, 0, 1, 2, 3), Double4),
            __builtin_convertvector(__builtin_shufflevector(x, x, 4, 5, 6, 7), Double4)};
}
inline Float8 to_float(const Double8& x) {
    typedef float Float4 __attribute__((vector_size(16)));
    const Float4 low = __builtin_convertvector(x.low, Float4);
    const Float4 high = __builtin_convertvector(x.high, Float4);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

inline Mask8 join(const Mask4& low, const Mask4& high) {
    typedef std::int32_t Mask4i __attribute__((vector_size(16)));
    return __builtin_shufflevector(__builtin_convertvector(low, Mask4i),
                                   __builtin_convertvector(high, Mask4i), 0, 1, 2, 3, 4, 5, 6, 7);
}
// Lanes that are not zero; what is not a number is not.
inline Mask8 not_zero(const Double8& x) { return join(x.low != 0.0, x.high != 0.0); }
inline bool not_zero(double x) { return x != 0; }
// Smaller, or not to be compared.
inline Mask8 not_at_least(const Double8& a, const Double8& b) {
    return join(~(a.low >= b.low), ~(a.high >= b.high));
}
inline bool not_at_least(double a, double b) { return !(a >= b); }

inline Float8 abs(const Float8& x) {
    return std::bit_cast<Float8>(std::bit_cast<Mask8>(x) & 0x7fffffff);
}
inline float abs(float x) { return std::abs(x); }
inline Mask8 is_finite(const Float8& x) { return x - x == 0; }
inline Float8 copy_sign(const Float8& magnitude, const Float8& sign) {
    return std::bit_cast<Float8>((std::bit_cast<Mask8>(magnitude) & 0x7fffffff) |
                                 (std::bit_cast<Mask8>(sign) & ~0x7fffffff));
}
inline Float8 sqrt(const Float8& x) {
#ifdef __AVX__
    return std::bit_cast<Float8>(_mm256_sqrt_ps(std::bit_cast<__m256>(x)));
#else
    Float8 r{};
    for (int k = 0; k < lane_count; ++k) r[k] = std::sqrt(x[k]);
    return r;
#endif
}
inline Float8 max(const Float8& a, const Float8& b) { return a < b ? b : a; }

// Lane k of the result is lane (k + shift) mod 8.
inline Mask8 rotation(int shift) { return (Mask8{0, 1, 2, 3, 4, 5, 6, 7} + shift) & 7; }
inline Float8 rotate(const Float8& x, const Mask8& from) { return __builtin_shuffle(x, from); }
inline Mask8 rotate(const Mask8& x, const Mask8& from) { return __builtin_shuffle(x, from); }
inline Double8 rotate(const Double8& x, const Mask8& from) {
    const Mask4 low = lower_half(from), high = upper_half(from);
    return {__builtin_shuffle(x.low, x.high, low), __builtin_shuffle(x.low, x.high, high)};
}

// By turns from a and b, within each half of four lanes: its lower two of either, its upper two.
inline Float8 interleave_low(const Float8& a, const Float8& b) {
    return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
}
inline Float8 interleave_high(const Float8& a, const Float8& b) {
    return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
}

struct Vec3x8 {
    Float8 x, y, z;

    vec3 operator[](int lane) const { return {x[lane], y[lane], z[lane]}; }
    void set(int lane, const vec3& v) {
        x[lane] = v.x;
        y[lane] = v.y;
        z[lane] = v.z;
    }
    friend Vec3x8 operator+(const Vec3x8& a, const Vec3x8& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend Vec3x8 operator-(const Vec3x8& a, const Vec3x8& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend Vec3x8 operator-(const Vec3x8& a) { return {-a.x, -a.y, -a.z}; }
    friend Vec3x8 operator*(const Vec3x8& a, const Vec3x8& b) {
        return {a.x * b.x, a.y * b.y, a.z * b.z};
    }
    friend Vec3x8 operator*(const Vec3x8& a, const Float8& b) {
        return {a.x * b, a.y * b, a.z * b};
    }
    friend Vec3x8 operator/(const Vec3x8& a, const Float8& b) {
        return {a.x / b, a.y / b, a.z / b};
    }
};

inline Vec3x8 all_lanes(const vec3& v) { return {all_lanes(v.x), all_lanes(v.y), all_lanes(v.z)}; }
inline Vec3x8 select(const Mask8& m, const Vec3x8& yes, const Vec3x8& no) {
    return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}
inline Vec3x8 rotate(const Vec3x8& v, const Mask8& from) {
    return {rotate(v.x, from), rotate(v.y, from), rotate(v.z, from)};
}

inline Float8 dot(const Vec3x8& a, const Vec3x8& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Float8 abs_dot(const Vec3x8& a, const Vec3x8& b) { return abs(dot(a, b)); }
inline Float8 length_squared(const Vec3x8& v) { return dot(v, v); }
inline Vec3x8 cross(const Vec3x8& a, const Vec3x8& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
inline Vec3x8 normalize(const Vec3x8& v) { return v * (1.0f / sqrt(dot(v, v))); }
inline Vec3x8 abs(const Vec3x8& v) { return {abs(v.x), abs(v.y), abs(v.z)}; }
inline Vec3x8 max(const Vec3x8& a, const Vec3x8& b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
inline Float8 max_component(const Vec3x8& v) { return max(v.x, max(v.y, v.z)); }
inline Mask8 is_finite(const Vec3x8& v) { return is_finite(v.x) & is_finite(v.y) & is_finite(v.z); }
inline Mask8 is_black(const Vec3x8& v) { return (v.x == 0) & (v.y == 0) & (v.z == 0); }

}  // namespace midway
