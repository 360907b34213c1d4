#include "math/sampler.h"

#include <bit>

namespace midway {
namespace {

// Four dimensions at once.
typedef std::uint32_t Lanes __attribute__((vector_size(16)));
typedef std::int32_t SignedLanes __attribute__((vector_size(16)));
typedef float FloatLanes __attribute__((vector_size(16)));
typedef std::uint8_t Bytes __attribute__((vector_size(16)));

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// The same in every lane: the order of the bytes by one shuffle, that of the bits in a byte by two
// look-ups of four bits.
Lanes reverse_bits(Lanes x) {
    constexpr Bytes order = {3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12};
    constexpr Bytes nibble = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    const Bytes b = __builtin_shuffle(std::bit_cast<Bytes>(x), order);
    const Bytes low = __builtin_shuffle(nibble, b & 15), high = __builtin_shuffle(nibble, b >> 4);
    return std::bit_cast<Lanes>((low << 4) | high);
}

// Hash in which bit i depends on bits 0..i alone: a nested uniform scramble of the reversed word
// (Laine & Karras 2011; constants of Burley 2020).
template <class T>
constexpr T scramble_reversed(T x, T seed) {
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

// Sobol values of an index, both reversed.
Lanes sobol_of_reversed(std::uint32_t r) {
    const auto of_byte = [r](int byte) {
        return std::bit_cast<Lanes>(table[byte][(r >> (8 * byte)) & 255]);
    };
    return of_byte(0) ^ of_byte(1) ^ of_byte(2) ^ of_byte(3);
}

Lanes owen_sobol_lanes(std::uint32_t index, std::uint64_t seed) {
    const std::uint64_t a = mix64(seed), b = mix64(a), c = mix64(b);
    // Shuffling the index decorrelates the groups of one sample.
    const std::uint32_t shuffled =
        scramble_reversed(reverse_bits(index), static_cast<std::uint32_t>(a));
    const Lanes scrambles = {static_cast<std::uint32_t>(a >> 32), static_cast<std::uint32_t>(b),
                             static_cast<std::uint32_t>(b >> 32), static_cast<std::uint32_t>(c)};
    return reverse_bits(scramble_reversed(sobol_of_reversed(shuffled), scrambles));
}

Lanes sample_lanes(const SampleKey& sample, std::uint32_t group) {
    if (sample.kind == SamplerKind::independent) {
        const std::uint64_t a = hash_combine(hash_combine(sample.key, group), mix64(sample.index));
        const std::uint64_t b = mix64(a);
        return Lanes{static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32),
                     static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(b >> 32)};
    }
    // A sequence is 2^32 points long; what lies beyond goes on with a new scramble.
    const std::uint64_t seed = hash_combine(sample.key + (sample.index >> 32), group);
    return owen_sobol_lanes(static_cast<std::uint32_t>(sample.index), seed);
}

// to_unit_float() in every lane: 24 bits fit the conversion from signed integers.
vec4 to_unit_floats(Lanes x) {
    const auto upper = std::bit_cast<SignedLanes>(x >> 8);
    return std::bit_cast<vec4>(__builtin_convertvector(upper, FloatLanes) * 0x1p-24f);
}

}  // namespace

Bits4 owen_sobol_4d(std::uint32_t index, std::uint64_t seed) {
    return std::bit_cast<Bits4>(owen_sobol_lanes(index, seed));
}

Bits4 sample_bits(const SampleKey& sample, std::uint32_t group) {
    return std::bit_cast<Bits4>(sample_lanes(sample, group));
}

vec4 sample_4d(const SampleKey& sample, std::uint32_t group) {
    return to_unit_floats(sample_lanes(sample, group));
}

std::array<vec4, 2> sample_4d_pair(const SampleKey& sample, std::uint32_t group) {
    const Lanes first = sample_lanes(sample, group), second = sample_lanes(sample, group + 1);
    return {to_unit_floats(first), to_unit_floats(second)};
}

}  // namespace midway
