#include "math/sampler.h"

#include <bit>

namespace midway {
namespace {

// Four dimensions at once; the functions below are written for both widths.
typedef std::uint32_t Lanes __attribute__((vector_size(16)));

template <class T>
constexpr T reverse_bits(T x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
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

// Bit-reversed Sobol value contributed by each byte of the index, for dimensions 1 to 3.
using ByteTable = std::array<std::array<std::uint32_t, 256>, 4>;

constexpr ByteTable make_table(const Polynomial& p) {
    std::array<std::uint32_t, 32> v{};
    for (int i = 0; i < p.degree; ++i) v[i] = p.m[i] << (31 - i);
    for (int i = p.degree; i < 32; ++i) {
        v[i] = v[i - p.degree] ^ (v[i - p.degree] >> p.degree);
        for (int k = 1; k < p.degree; ++k)
            if ((p.coefficients >> (p.degree - 1 - k)) & 1) v[i] ^= v[i - k];
    }
    ByteTable table{};
    for (int byte = 0; byte < 4; ++byte)
        for (int value = 0; value < 256; ++value) {
            std::uint32_t x = 0;
            for (int bit = 0; bit < 8; ++bit)
                if ((value >> bit) & 1) x ^= v[byte * 8 + bit];
            table[byte][value] = reverse_bits(x);
        }
    return table;
}

constexpr ByteTable tables[3] = {make_table({1, 0, {1}}), make_table({2, 1, {1, 3}}),
                                 make_table({3, 1, {1, 3, 1}})};

std::uint32_t reversed_sobol(const ByteTable& t, std::uint32_t i) {
    return t[0][i & 255] ^ t[1][(i >> 8) & 255] ^ t[2][(i >> 16) & 255] ^ t[3][i >> 24];
}

}  // namespace

Bits4 owen_sobol_4d(std::uint32_t index, std::uint64_t seed) {
    const std::uint64_t a = mix64(seed), b = mix64(a), c = mix64(b);
    // Shuffling the index decorrelates the groups of one sample.
    const std::uint32_t shuffled =
        reverse_bits(scramble_reversed(reverse_bits(index), static_cast<std::uint32_t>(a)));
    const Lanes reversed = {shuffled, reversed_sobol(tables[0], shuffled),
                            reversed_sobol(tables[1], shuffled),
                            reversed_sobol(tables[2], shuffled)};
    const Lanes scrambles = {
        static_cast<std::uint32_t>(a >> 32), static_cast<std::uint32_t>(b),
        static_cast<std::uint32_t>(b >> 32), static_cast<std::uint32_t>(c)};
    return std::bit_cast<Bits4>(reverse_bits(scramble_reversed(reversed, scrambles)));
}

Bits4 sample_bits(const SampleKey& sample, std::uint32_t group) {
    if (sample.kind == SamplerKind::independent) {
        const std::uint64_t a = hash_combine(hash_combine(sample.key, group), mix64(sample.index));
        const std::uint64_t b = mix64(a);
        return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32),
                static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(b >> 32)};
    }
    // A sequence is 2^32 points long; what lies beyond goes on with a new scramble.
    const std::uint64_t seed = hash_combine(sample.key + (sample.index >> 32), group);
    return owen_sobol_4d(static_cast<std::uint32_t>(sample.index), seed);
}

}  // namespace midway
