// Random numbers of one sample, as a pure function of (key, index, group): no state is carried from
// sample to sample, so any sample can be computed again alone. A group is a set of up to four
// dimensions stratified together over the indices of one key; groups are padded, i.e. independently
// shuffled and scrambled (Burley 2020, "Practical Hash-based Owen Scrambling"). Groups 2n and
// 2n + 1 are computed together.
#pragma once

#include <array>
#include <cstdint>

#include "math/hash.h"
#include "math/lanes.h"

namespace midway {

enum class SamplerKind : std::uint8_t { sobol, independent };

// Identifies one sample of one stream; see make_sample_key().
struct SampleKey {
    std::uint64_t key = 0;
    std::uint32_t reversed = 0;  // the lower half of the place in the sequence, last bit first
    SamplerKind kind = SamplerKind::sobol;
};

// `key` fixes the scramble (seed, stream, half and pixel) and is itself a hash; `index` is the
// place in the sequence.
SampleKey make_sample_key(std::uint64_t key, std::uint64_t index, SamplerKind kind);

using Bits4 = std::array<std::uint32_t, 4>;

// Four 32-bit numbers of a group, each uniform over its range.
Bits4 sample_bits(const SampleKey& sample, std::uint32_t group);

// The same as floats in [0, 1 - 2^-24].
vec4 sample_4d(const SampleKey& sample, std::uint32_t group);

// Of an even group and the next one: as quick as one of them.
std::array<vec4, 2> sample_4d_pair(const SampleKey& sample, std::uint32_t group);

// The same for eight samples, one in each lane; lanes that are not wanted get any numbers.
struct NumberLanes {
    std::array<Float8, 4> first, second;
};
NumberLanes sample_4d_pairs(const std::array<SampleKey, lane_count>& samples, const Mask8& wanted,
                            std::uint32_t group);

}  // namespace midway
