// Checked reading of accessors: dense, interleaved, sparse, normalised, of every component type.
// Every range is proven to lie inside its buffer before a byte is read. Internal to renderer/io;
// throws std::runtime_error "WHAT (FILE); REMEDY".
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "io/gltf_document.h"

namespace midway::gltf {

// Elements that an accessor without a buffer view may have: it costs its author nothing.
inline constexpr std::size_t max_implicit_elements = std::size_t{1} << 24;

// The number of components of an accessor's elements.
int component_count(const Document& document, int accessor);

// Element after element, `components` floats each; integers are normalised where the accessor says
// so.
std::vector<float> read_floats(Document& document, int accessor, int components);

// Scalars of an unsigned integer type.
std::vector<std::uint32_t> read_indices(Document& document, int accessor);

// Vectors of V::length() floats.
template <typename V>
std::vector<V> read_vectors(Document& document, int accessor) {
    constexpr int components = V::length();
    const std::vector<float> values = read_floats(document, accessor, components);
    std::vector<V> out(values.size() / components);
    for (std::size_t i = 0; i < out.size(); ++i) {
        for (int c = 0; c < components; ++c) out[i][c] = values[i * components + c];
    }
    return out;
}

}  // namespace midway::gltf
