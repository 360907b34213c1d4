// Integer hashes that keys of the random streams go through.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace midway {

// 2^64 over the golden ratio: its multiples lie far apart.
inline constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ull;

// Finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection of 64 bits.
constexpr std::uint64_t mix64(std::uint64_t x) {
    x += golden;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

constexpr std::uint64_t hash_combine(std::uint64_t a, std::uint64_t b) {
    return mix64(a ^ mix64(b));
}

// Goes on from `state` with n bytes.
inline std::uint64_t hash_bytes(std::uint64_t state, const void* data, std::size_t n) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (; n >= 8; n -= 8, p += 8) {
        std::uint64_t word;
        std::memcpy(&word, p, 8);
        state = hash_combine(state, word);
    }
    std::uint64_t tail = 0;
    // An empty array may have no address.
    if (n > 0) std::memcpy(&tail, p, n);
    return hash_combine(state, tail + n);
}

// Uniform float in [0, 1 - 2^-24] from the upper 24 bits.
constexpr float to_unit_float(std::uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}

// A permutation of [0, n) chosen by `key`, a hash: steps that can be undone on the next power of
// two, walked until the value falls into range (Black & Rogaway 2002, cycle walking; such steps:
// Kensler 2013, "Correlated Multi-Jittered Sampling").
constexpr std::uint64_t permute_index(std::uint64_t index, std::uint64_t n, std::uint64_t key) {
    const int bits = std::bit_width(n - 1), half = bits / 2 + 1;
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    do {
        std::uint64_t k = key;
        for (int round = 0; round < 4; ++round) {
            index = (index * ((k >> 32) | 1) + k) & mask;
            index ^= index >> half;
            k = k * 0xd1342543de82ef95ull + golden;
        }
        index = (index * ((k >> 32) | 1) + k) & mask;
    } while (index >= n);
    return index;
}

}  // namespace midway
