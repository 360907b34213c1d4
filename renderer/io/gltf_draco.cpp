#include <draco/compression/decode.h>

#include <cstring>
#include <map>

#include "io/gltf_compression.h"

namespace midway::gltf {
namespace {

constexpr int max_components = 4;

std::unique_ptr<draco::Mesh> decode_mesh(const RawDocument& document, const Json& extension) {
    const std::uint64_t index = natural(document, extension, "bufferView");
    const Json* views = find(document.root, "bufferViews");
    if (!views || !views->is_array() || index >= views->size()) {
        fail(document.path, "buffer view " + std::to_string(index) + " does not exist");
    }
    const Json& view = (*views)[index];
    const ByteSpan bytes = buffer_range(document, natural(document, view, "buffer"),
                                        natural(document, view, "byteOffset", 0),
                                        natural(document, view, "byteLength"));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) return nullptr;
    return std::move(result).value();
}

template <typename T>
bool copy_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components,
                    Bytes& out) {
    T values[max_components] = {};
    const std::size_t row = sizeof(T) * static_cast<std::size_t>(components);
    out.resize(row * mesh.num_points());
    for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
        const draco::AttributeValueIndex value = attribute.mapped_index(i);
        if (value.value() >= attribute.size()) return false;
        if (!attribute.ConvertValue<T>(value, static_cast<std::int8_t>(components), values)) {
            return false;
        }
        std::memcpy(out.data() + row * i.value(), values, row);
    }
    return true;
}

int component_count(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    return type == "VEC4" ? 4 : 0;
}

// The attribute's values in the component type and width that its accessor announces.
bool convert_attribute(const RawDocument& document, const draco::Mesh& mesh, int id,
                       const Json& accessor, Bytes& out) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(static_cast<unsigned>(id));
    const int components = component_count(text(accessor, "type"));
    if (!attribute || components == 0) return false;
    switch (natural(document, accessor, "componentType")) {
        case 5120:
            return copy_attribute<std::int8_t>(mesh, *attribute, components, out);
        case 5121:
            return copy_attribute<std::uint8_t>(mesh, *attribute, components, out);
        case 5122:
            return copy_attribute<std::int16_t>(mesh, *attribute, components, out);
        case 5123:
            return copy_attribute<std::uint16_t>(mesh, *attribute, components, out);
        case 5125:
            return copy_attribute<std::uint32_t>(mesh, *attribute, components, out);
        case 5126:
            return copy_attribute<float>(mesh, *attribute, components, out);
        default:
            return false;
    }
}

Bytes face_indices(const draco::Mesh& mesh) {
    Bytes out(std::size_t{12} * mesh.num_faces());
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
        const draco::Mesh::Face& face = mesh.face(f);
        const std::uint32_t corners[3] = {face[0].value(), face[1].value(), face[2].value()};
        std::memcpy(out.data() + std::size_t{12} * f.value(), corners, sizeof corners);
    }
    return out;
}

int append_accessor(RawDocument& document, Bytes bytes, Json accessor, std::uint64_t count) {
    accessor["bufferView"] = append_view(document, std::move(bytes), 0);
    accessor["count"] = count;
    accessor.erase("byteOffset");
    accessor.erase("sparse");
    Json& accessors = document.root["accessors"];
    accessors.push_back(std::move(accessor));
    return static_cast<int>(accessors.size() - 1);
}

// Decodes one primitive into new accessors. False where the data is damaged.
bool decode_primitive(RawDocument& document, Json& primitive, const Json& extension,
                      std::uint64_t& bytes_left) {
    Json* attributes = find(primitive, "attributes");
    const Json* ids = find(extension, "attributes");
    const std::unique_ptr<draco::Mesh> mesh = decode_mesh(document, extension);
    if (!mesh || !attributes || !ids || !ids->is_object()) return false;
    const std::uint64_t connectivity = std::uint64_t{12} * mesh->num_faces();
    if (connectivity > bytes_left) return false;
    bytes_left -= connectivity;
    std::map<std::string, int> decoded;
    for (const auto& [name, id] : ids->items()) {
        const Json* index = find(*attributes, name.c_str());
        const Json* accessors = find(document.root, "accessors");
        if (!index || !index->is_number_unsigned() || !id.is_number_unsigned() || !accessors ||
            *index >= accessors->size() || id > 0x7fffffff) {
            return false;
        }
        const Json accessor = (*accessors)[index->get<std::size_t>()];
        const std::uint64_t most = std::uint64_t{16} * mesh->num_points();
        if (most > bytes_left) return false;
        bytes_left -= most;
        Bytes bytes;
        if (!convert_attribute(document, *mesh, id.get<int>(), accessor, bytes)) return false;
        decoded[name] = append_accessor(document, std::move(bytes), accessor, mesh->num_points());
    }
    for (const auto& [name, accessor] : decoded) (*attributes)[name] = accessor;
    const Json accessor = {{"componentType", 5125}, {"type", "SCALAR"}};
    const std::uint64_t corners = std::uint64_t{3} * mesh->num_faces();
    primitive["indices"] = append_accessor(document, face_indices(*mesh), accessor, corners);
    primitive["mode"] = 4;
    return true;
}

}  // namespace

void decode_draco(RawDocument& document) {
    Json::array_t* meshes = array(document, "meshes");
    if (!meshes) return;
    std::uint64_t bytes_left = max_decoded_bytes;
    for (std::size_t m = 0; m < meshes->size(); ++m) {
        Json* primitives = find((*meshes)[m], "primitives");
        if (!primitives || !primitives->is_array()) continue;
        for (Json& primitive : *primitives) {
            const Json* extensions = find(primitive, "extensions");
            const Json* found =
                extensions ? find(*extensions, "KHR_draco_mesh_compression") : nullptr;
            if (!found) continue;
            const Json extension = *found;
            if (!decode_primitive(document, primitive, extension, bytes_left)) {
                fail(document.path,
                     "Draco data of mesh " + std::to_string(m) + " cannot be decoded");
            }
        }
    }
}

}  // namespace midway::gltf
