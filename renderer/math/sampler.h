// Random numbers of one sample, as a pure function of (key, index, group): no state is carried from
// sample to sample, so any sample can be computed again alone. A group is a set of up to four
// dimensions stratified together over the indices of one key; groups are padded, i.e. independently
// shuffled and scrambled (Burley 2020, "Practical Hash-based Owen Scrambling").
#pragma once

#include <array>
#include <cstdint>

#include "math/hash.h"
#include "math/vector.h"

namespace midway {

enum class SamplerKind : std::uint8_t { sobol, independent };

// Identifies one sample of one stream. `key` fixes the scramble (seed, stream, half and pixel),
// `index` is the place in the sequence.
struct SampleKey {
    std::uint64_t key = 0;
    std::uint64_t index = 0;
    SamplerKind kind = SamplerKind::sobol;
};

using Bits4 = std::array<std::uint32_t, 4>;

// The first four dimensions of the Sobol sequence (Joe & Kuo 2008), Owen-scrambled.
Bits4 owen_sobol_4d(std::uint32_t index, std::uint64_t seed);

// Four 32-bit numbers of a group, each uniform over its range.
Bits4 sample_bits(const SampleKey& sample, std::uint32_t group);

// The same as floats in [0, 1 - 2^-24].
vec4 sample_4d(const SampleKey& sample, std::uint32_t group);

// Of `group` and the next one: together they take little longer than one, each being a long chain
// of operations that wait for each other.
std::array<vec4, 2> sample_4d_pair(const SampleKey& sample, std::uint32_t group);

}  // namespace midway
