#include "io/gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/gltf_accessor.h"
#include "io/tangents.h"

namespace midway::gltf {
namespace {

template <typename To, typename From>
std::vector<To> convert(const std::vector<From>& values) {
    std::vector<To> out;
    out.reserve(values.size());
    for (const From& value : values) out.push_back(To(value));
    return out;
}

// An optional attribute; left out with a warning where it does not have one element per vertex.
template <typename V>
std::vector<V> read_attribute(Document& document, const tinygltf::Primitive& primitive,
                              const char* key, std::size_t count, const std::string& name) {
    const int accessor = attribute(primitive.attributes, key);
    if (accessor < 0) return {};
    std::vector<V> values = read_vectors<V>(document, accessor);
    if (values.size() == count) return values;
    warn(document, name + ": " + key + " has " + std::to_string(values.size()) + " elements for " +
                       std::to_string(count) + " vertices; left out");
    return {};
}

std::vector<vec4> read_colors(Document& document, const tinygltf::Primitive& primitive,
                              std::size_t count, const std::string& name) {
    const int accessor = attribute(primitive.attributes, "COLOR_0");
    if (accessor < 0) return {};
    if (component_count(document, accessor) == 4) {
        return read_attribute<vec4>(document, primitive, "COLOR_0", count, name);
    }
    std::vector<vec4> out;
    for (const vec3& color : read_attribute<vec3>(document, primitive, "COLOR_0", count, name)) {
        out.emplace_back(color, 1.0f);
    }
    return out;
}

Vertices read_vertices(Document& document, const tinygltf::Primitive& primitive,
                       const std::string& name) {
    Vertices out;
    const int positions = attribute(primitive.attributes, "POSITION");
    if (positions < 0) return out;
    out.positions = convert<dvec3>(read_vectors<vec3>(document, positions));
    const std::size_t count = out.positions.size();
    out.normals = convert<dvec3>(read_attribute<vec3>(document, primitive, "NORMAL", count, name));
    // Tangents of a mesh without normals are to be ignored (glTF 2.0, 3.7.2.1).
    if (!out.normals.empty()) {
        out.tangents =
            convert<dvec4>(read_attribute<vec4>(document, primitive, "TANGENT", count, name));
    }
    out.texcoords[0] = read_attribute<vec2>(document, primitive, "TEXCOORD_0", count, name);
    out.texcoords[1] = read_attribute<vec2>(document, primitive, "TEXCOORD_1", count, name);
    out.colors = read_colors(document, primitive, count, name);
    return out;
}

// Corners of triangles in order, whichever of the three modes the primitive has. Strips and fans:
// glTF 2.0, 3.7.2.1; the triangles that strips repeat a vertex in are not data and are left out.
std::vector<uvec3> assemble(const std::vector<std::uint32_t>& corners, int mode) {
    std::vector<uvec3> out;
    const std::size_t count = corners.size();
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        out.reserve(count / 3);
        for (std::size_t i = 0; i + 2 < count; i += 3) {
            out.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
        }
        return out;
    }
    for (std::size_t i = 0; i + 2 < count; ++i) {
        uvec3 triangle(corners[0], corners[i + 1], corners[i + 2]);
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            triangle = uvec3(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
        }
        const bool repeats =
            triangle.x == triangle.y || triangle.y == triangle.z || triangle.z == triangle.x;
        if (!repeats) out.push_back(triangle);
    }
    return out;
}

std::vector<uvec3> read_triangles(Document& document, const tinygltf::Primitive& primitive,
                                  std::size_t vertex_count, const std::string& name) {
    std::vector<std::uint32_t> corners;
    if (primitive.indices >= 0) {
        corners = read_indices(document, primitive.indices);
    } else {
        if (vertex_count > 0xffffffffu) fail(document.path, name + " has too many vertices");
        corners.resize(vertex_count);
        for (std::size_t i = 0; i < vertex_count; ++i) corners[i] = static_cast<std::uint32_t>(i);
    }
    for (const std::uint32_t corner : corners) {
        if (corner >= vertex_count) {
            fail(document.path, name + " refers to vertex " + std::to_string(corner) + " of " +
                                    std::to_string(vertex_count));
        }
    }
    return assemble(corners, primitive.mode);
}

// The middle of the finite positions.
dvec3 middle(const std::vector<dvec3>& positions) {
    dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (const dvec3& p : positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return low.x <= high.x ? low * 0.5 + high * 0.5 : dvec3(0);
}

Mesh to_mesh(Vertices&& vertices) {
    Mesh mesh;
    mesh.positions = convert<vec3>(vertices.positions);
    mesh.normals = convert<vec3>(vertices.normals);
    mesh.tangents = convert<vec4>(vertices.tangents);
    mesh.texcoords = std::move(vertices.texcoords);
    mesh.colors = std::move(vertices.colors);
    return mesh;
}

bool deform(Document& document, const tinygltf::Primitive& primitive,
            const Deformation& deformation, Vertices& vertices) {
    apply_morph_targets(document, primitive, deformation.weights, vertices);
    if (!deformation.joints.empty()) {
        return apply_skin(document, primitive, deformation.joints, vertices);
    }
    if (deformation.bake) transform_vertices(*deformation.bake, vertices);
    return deformation.bake.has_value();
}

}  // namespace

int attribute(const std::map<std::string, int>& attributes, const std::string& name) {
    const auto it = attributes.find(name);
    return it == attributes.end() ? -1 : it->second;
}

std::optional<BuiltMesh> build_mesh(Document& document, const tinygltf::Primitive& primitive,
                                    const Deformation& deformation, int tangents_from,
                                    const std::string& name) {
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        warn(document, name + " consists of points or lines; left out");
        return std::nullopt;
    }
    Vertices vertices = read_vertices(document, primitive, name);
    const std::vector<uvec3> triangles =
        read_triangles(document, primitive, vertices.positions.size(), name);
    BuiltMesh out;
    if (deform(document, primitive, deformation, vertices)) {
        out.world_origin = middle(vertices.positions);
        for (dvec3& p : vertices.positions) p -= *out.world_origin;
    }
    out.mesh = to_mesh(std::move(vertices));
    out.mesh.triangles = triangles;
    out.mesh.name = name;
    clean_mesh(document, name, out.mesh);
    if (out.mesh.triangles.empty()) {
        warn(document, name + " has no triangles; left out");
        return std::nullopt;
    }
    const bool wanted = tangents_from >= 0 && out.mesh.tangents.empty();
    if (wanted && !out.mesh.texcoords[static_cast<std::size_t>(tangents_from)].empty()) {
        generate_tangents(out.mesh, tangents_from);
    }
    return out;
}

}  // namespace midway::gltf
