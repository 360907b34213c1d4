#include "math/sampler.h"

#include <immintrin.h>

#include <bit>

namespace midway {
namespace {

// Both groups of a pair at once.
typedef std::uint32_t Lanes __attribute__((vector_size(32)));
typedef std::uint64_t WideLanes __attribute__((vector_size(32)));
typedef std::uint8_t Bytes __attribute__((vector_size(32)));
typedef std::uint32_t Group __attribute__((vector_size(16)));

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// table[i] in every byte, i below 16.
Bytes look_up(const Bytes& table, const Bytes& i) {
#ifdef __AVX2__
    // Within each half of 16 bytes.
    return std::bit_cast<Bytes>(
        _mm256_shuffle_epi8(std::bit_cast<__m256i>(table), std::bit_cast<__m256i>(i)));
#else
    Bytes found{};
    for (int k = 0; k < 32; ++k) found[k] = table[i[k]];
    return found;
#endif
}

// The same in every lane: the order of the bytes by one shuffle, that of the bits in a byte by two
// look-ups of four bits.
Lanes reverse_bits(const Lanes& x) {
    constexpr Bytes order = {3,  2,  1,  0,  7,  6,  5,  4,  11, 10, 9,  8,  15, 14, 13, 12,
                             19, 18, 17, 16, 23, 22, 21, 20, 27, 26, 25, 24, 31, 30, 29, 28};
    constexpr Bytes upper = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15,
                             0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    constexpr Bytes lower = upper << 4;
    const Bytes b = __builtin_shuffle(std::bit_cast<Bytes>(x), order);
    return std::bit_cast<Lanes>(look_up(lower, b & 15) | look_up(upper, b >> 4));
}

// Hash in which bit i depends on bits 0..i alone: a nested uniform scramble of the reversed word
// (Laine & Karras 2011; constants of Burley 2020).
template <class T>
constexpr T scramble_reversed(T x, const T& seed) {
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

// Direction numbers from the primitive polynomials and initial values of Joe & Kuo 2008: degree,
// coefficients, m_1..m_degree.
struct Polynomial {
    int degree;
    std::uint32_t coefficients;
    std::uint32_t m[3];
};

constexpr void fill_directions(const Polynomial& p, std::uint32_t (&v)[32]) {
    for (int i = 0; i < p.degree; ++i) v[i] = p.m[i] << (31 - i);
    for (int i = p.degree; i < 32; ++i) {
        v[i] = v[i - p.degree] ^ (v[i - p.degree] >> p.degree);
        for (int k = 1; k < p.degree; ++k)
            if ((p.coefficients >> (p.degree - 1 - k)) & 1) v[i] ^= v[i - k];
    }
}

// What each byte of a bit-reversed index contributes to the four bit-reversed Sobol values.
typedef std::array<std::array<Bits4, 256>, 4> ByteTable;

constexpr ByteTable make_table() {
    constexpr Polynomial polynomials[3] = {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}};
    std::uint32_t v[4][32] = {};
    for (int i = 0; i < 32; ++i) v[0][i] = 1u << (31 - i);  // van der Corput's sequence
    for (int d = 0; d < 3; ++d) fill_directions(polynomials[d], v[d + 1]);
    ByteTable table{};
    for (int byte = 0; byte < 4; ++byte)
        for (std::uint32_t value = 0; value < 256; ++value) {
            Bits4& x = table[byte][value];
            for (int bit = 0; bit < 8; ++bit)
                if ((value >> bit) & 1)
                    for (int d = 0; d < 4; ++d) x[d] ^= v[d][31 - (byte * 8 + bit)];
            for (std::uint32_t& word : x) word = reverse_bits(word);
        }
    return table;
}

alignas(16) constexpr ByteTable table = make_table();

// Sobol values of two indices, all reversed, side by side. Both indices have no more bits than
// `longest`: most sequences are short, and their upper bytes need not be looked up.
Lanes sobol_of_reversed(std::uint32_t a, std::uint32_t b, std::uint32_t longest) {
    Group first = std::bit_cast<Group>(table[3][a >> 24]);
    Group second = std::bit_cast<Group>(table[3][b >> 24]);
    const auto add = [&](int byte) {
        first ^= std::bit_cast<Group>(table[byte][(a >> (8 * byte)) & 255]);
        second ^= std::bit_cast<Group>(table[byte][(b >> (8 * byte)) & 255]);
    };
    if (longest << 8) add(2);
    if (longest << 16) add(1);
    if (longest << 24) add(0);
    return __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Shuffles an index (reversed) among those of the same length. Numbers that differ by a shift of
// all digits are as good, since the values are scrambled after: so the leading ones are free to
// stay, and the index keeps the length that it has.
std::uint32_t shuffle_reversed(std::uint32_t reversed, std::uint32_t seed) {
    const std::uint32_t leading = reversed & -reversed;
    const std::uint32_t from_leading = reversed ^ (reversed - 1);
    return (scramble_reversed(reversed, seed) & ~from_leading) | leading;
}

// A seed for each dimension of a pair.
Lanes lane_seeds(std::uint64_t hash) {
    constexpr Lanes factors = {0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du, 0x27d4eb2fu,
                               0x165667b1u, 0x7feb352du, 0x846ca68bu, 0xd6e8feb9u};
    const Lanes x = static_cast<std::uint32_t>(hash) * factors;
    return (x ^ (x >> 16)) + static_cast<std::uint32_t>(hash >> 32);
}

// The groups 2 pair and 2 pair + 1.
Lanes sample_lanes(const SampleKey& sample, std::uint32_t pair) {
    if (sample.kind == SamplerKind::independent) {
        const std::uint64_t first = sample.key + 4 * pair * golden;
        return std::bit_cast<Lanes>(WideLanes{mix64(first), mix64(first + golden),
                                              mix64(first + 2 * golden),
                                              mix64(first + 3 * golden)});
    }
    const std::uint64_t hash = mix64(sample.key + pair * golden);
    // Shuffling the index decorrelates the groups of one sample.
    const std::uint32_t r = sample.reversed;
    const std::uint32_t a = shuffle_reversed(r, static_cast<std::uint32_t>(hash));
    const std::uint32_t b = shuffle_reversed(r, static_cast<std::uint32_t>(hash >> 32));
    return reverse_bits(scramble_reversed(sobol_of_reversed(a, b, r), lane_seeds(hash)));
}

// to_unit_float() in every lane: 24 bits fit the conversion from signed integers.
Float8 to_unit_lanes(const Lanes& x) {
    return __builtin_convertvector(std::bit_cast<Mask8>(x >> 8), Float8) * 0x1p-24f;
}
std::array<vec4, 2> to_unit_floats(const Lanes& x) {
    return std::bit_cast<std::array<vec4, 2>>(to_unit_lanes(x));
}

// Numbers 0 to 3 of eight rows (or 4 to 7), as columns.
template <int first>
std::array<Float8, 4> columns(const std::array<Float8, lane_count>& rows) {
    // Rows k and k + 4 side by side.
    const auto half = [&](int k) {
        return __builtin_shufflevector(rows[k], rows[k + 4], first, first + 1, first + 2, first + 3,
                                       first + 8, first + 9, first + 10, first + 11);
    };
    const Float8 a = half(0), b = half(1), c = half(2), d = half(3);
    const Float8 ac_low = interleave_low(a, c), bd_low = interleave_low(b, d);
    const Float8 ac_high = interleave_high(a, c), bd_high = interleave_high(b, d);
    return {interleave_low(ac_low, bd_low), interleave_high(ac_low, bd_low),
            interleave_low(ac_high, bd_high), interleave_high(ac_high, bd_high)};
}

}  // namespace

SampleKey make_sample_key(std::uint64_t key, std::uint64_t index, SamplerKind kind) {
    if (kind == SamplerKind::independent) return {hash_combine(key, index), 0, kind};
    // A sequence is 2^32 points long; what lies beyond goes on with a new scramble.
    return {key + (index >> 32) * 0xd1342543de82ef95ull,
            reverse_bits(static_cast<std::uint32_t>(index)), kind};
}

Bits4 sample_bits(const SampleKey& sample, std::uint32_t group) {
    return std::bit_cast<std::array<Bits4, 2>>(sample_lanes(sample, group / 2))[group % 2];
}

vec4 sample_4d(const SampleKey& sample, std::uint32_t group) {
    return to_unit_floats(sample_lanes(sample, group / 2))[group % 2];
}

std::array<vec4, 2> sample_4d_pair(const SampleKey& sample, std::uint32_t group) {
    return to_unit_floats(sample_lanes(sample, group / 2));
}

NumberLanes sample_4d_pairs(const std::array<SampleKey, lane_count>& samples, const Mask8& wanted,
                            std::uint32_t group) {
    std::array<Float8, lane_count> rows{};
    for_each_lane(wanted,
                  [&](int k) { rows[k] = to_unit_lanes(sample_lanes(samples[k], group / 2)); });
    return {columns<0>(rows), columns<4>(rows)};
}

}  // namespace midway
