#include "io/gltf_accessor.h"

#include <algorithm>
#include <cstring>

namespace midway::gltf {
namespace {

// A checked range of equally spaced elements. Null data: all zero.
struct Elements {
    const std::uint8_t* data = nullptr;
    std::size_t count = 0, stride = 0;
    int component_type = 0, components = 0;
    bool normalized = false;
};

std::size_t component_bytes(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

template <typename T>
T load(const std::uint8_t* data) {
    T value;
    std::memcpy(&value, data, sizeof value);
    return value;
}

// glTF 2.0, 3.6.2.2: integers to floats.
float load_float(const std::uint8_t* data, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const float value = load<std::int8_t>(data);
            return normalized ? std::max(value / 127.0f, -1.0f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
            const float value = load<std::uint8_t>(data);
            return normalized ? value / 255.0f : value;
        }
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const float value = load<std::int16_t>(data);
            return normalized ? std::max(value / 32767.0f, -1.0f) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
            const float value = load<std::uint16_t>(data);
            return normalized ? value / 65535.0f : value;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return static_cast<float>(load<std::uint32_t>(data));
        default:
            return load<float>(data);
    }
}

std::uint32_t load_index(const std::uint8_t* data, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(data);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(data);
        default:
            return load<std::uint32_t>(data);
    }
}

bool is_index_type(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// Pointer to `count` elements of `size` bytes, `stride` apart, at `offset` of a view.
const std::uint8_t* checked_range(const Document& document, int view, std::size_t offset,
                                  const Elements& elements, std::size_t size,
                                  const std::string& name) {
    const ByteSpan bytes = view_bytes(document, view);
    const bool start = offset <= bytes.size() && size <= bytes.size() - offset;
    if (!start || (elements.count - 1) > (bytes.size() - offset - size) / elements.stride) {
        fail(document.path, name + " reaches past the end of its buffer view");
    }
    return bytes.data() + offset;
}

Elements open_elements(Document& document, int index, int components) {
    const tinygltf::Accessor& accessor = at(document, document.model.accessors, index, "accessor");
    const std::string name = "accessor " + std::to_string(index);
    Elements out{nullptr,    accessor.count,     0, accessor.componentType,
                 components, accessor.normalized};
    const std::size_t size = component_bytes(accessor.componentType) * components;
    if (size == 0) fail(document.path, name + " has an unknown component type");
    if (component_count(document, index) != components) {
        fail(document.path, name + " has the wrong type for its use");
    }
    if (accessor.count > document.elements_left) {
        fail(document.path, "more than 2^29 vertices and indices", "split the scene");
    }
    document.elements_left -= accessor.count;
    out.stride = size;
    if (accessor.count == 0) return out;
    if (accessor.bufferView < 0) {
        if (accessor.count > max_implicit_elements)
            fail(document.path, name + " has too many elements");
        return out;
    }
    const auto& view = at(document, document.model.bufferViews, accessor.bufferView, "buffer view");
    if (view.byteStride > 0) out.stride = view.byteStride;
    if (out.stride < size) fail(document.path, name + " has an impossible stride");
    out.data = checked_range(document, accessor.bufferView, accessor.byteOffset, out, size, name);
    return out;
}

// Calls set(element, bytes of its value) for each element that a sparse accessor replaces.
template <typename Set>
void for_each_sparse(Document& document, int index, const Elements& elements, Set&& set) {
    const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
    if (!accessor.sparse.isSparse || accessor.sparse.count == 0) return;
    const auto& sparse = accessor.sparse;
    const std::string name = "sparse accessor " + std::to_string(index);
    if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor.count ||
        sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
        !is_index_type(sparse.indices.componentType)) {
        fail(document.path, name + " has impossible parameters");
    }
    const std::size_t index_size = component_bytes(sparse.indices.componentType);
    const std::size_t value_size = component_bytes(elements.component_type) * elements.components;
    Elements packed;
    packed.count = static_cast<std::size_t>(sparse.count);
    packed.stride = index_size;
    const std::uint8_t* places = checked_range(document, sparse.indices.bufferView,
                                               static_cast<std::size_t>(sparse.indices.byteOffset),
                                               packed, index_size, name);
    packed.stride = value_size;
    const std::uint8_t* values =
        checked_range(document, sparse.values.bufferView,
                      static_cast<std::size_t>(sparse.values.byteOffset), packed, value_size, name);
    for (std::size_t i = 0; i < packed.count; ++i) {
        const std::size_t place = load_index(places + i * index_size, sparse.indices.componentType);
        if (place >= accessor.count)
            fail(document.path, name + " replaces elements beyond its end");
        set(place, values + i * value_size);
    }
}

}  // namespace

int component_count(const Document& document, int accessor) {
    switch (at(document, document.model.accessors, accessor, "accessor").type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        case TINYGLTF_TYPE_MAT2:
            return 4;
        case TINYGLTF_TYPE_MAT3:
            return 9;
        case TINYGLTF_TYPE_MAT4:
            return 16;
        default:
            return 0;
    }
}

std::vector<float> read_floats(Document& document, int accessor, int components) {
    const Elements elements = open_elements(document, accessor, components);
    const std::size_t size = component_bytes(elements.component_type);
    std::vector<float> out(elements.count * components, 0.0f);
    const auto set = [&](std::size_t element, const std::uint8_t* data) {
        for (int c = 0; c < components; ++c) {
            out[element * components + c] =
                load_float(data + c * size, elements.component_type, elements.normalized);
        }
    };
    for (std::size_t i = 0; elements.data && i < elements.count; ++i) {
        set(i, elements.data + i * elements.stride);
    }
    for_each_sparse(document, accessor, elements, set);
    return out;
}

std::vector<std::uint32_t> read_indices(Document& document, int accessor) {
    const Elements elements = open_elements(document, accessor, 1);
    if (!is_index_type(elements.component_type)) {
        fail(document.path, "accessor " + std::to_string(accessor) + " cannot hold indices");
    }
    std::vector<std::uint32_t> out(elements.count, 0);
    const auto set = [&](std::size_t element, const std::uint8_t* data) {
        out[element] = load_index(data, elements.component_type);
    };
    for (std::size_t i = 0; elements.data && i < elements.count; ++i) {
        set(i, elements.data + i * elements.stride);
    }
    for_each_sparse(document, accessor, elements, set);
    return out;
}

}  // namespace midway::gltf
