// Morph targets (glTF 2.0, 3.7.2.2) and skins (3.7.3), evaluated once for the pose of the file.
#include <cmath>

#include "io/gltf_accessor.h"
#include "io/gltf_mesh.h"

namespace midway::gltf {
namespace {

// Adds weight times the target's attribute to the components that both have.
template <typename Target, typename V>
void add_target(Document& document, int accessor, double weight, std::vector<V>& values) {
    if (accessor < 0 || values.empty()) return;
    const std::vector<Target> deltas = read_vectors<Target>(document, accessor);
    if (deltas.size() != values.size()) {
        warn(document, "a morph target has another number of vertices than its mesh; left out");
        return;
    }
    for (std::size_t i = 0; i < deltas.size(); ++i) {
        for (int c = 0; c < Target::length(); ++c) {
            values[i][c] += static_cast<typename V::value_type>(weight * deltas[i][c]);
        }
    }
}

struct Influences {
    std::vector<vec4> joints, weights;
};

std::vector<Influences> read_influences(Document& document, const tinygltf::Primitive& primitive,
                                        std::size_t vertex_count) {
    std::vector<Influences> sets;
    for (int set = 0;; ++set) {
        const int joints = attribute(primitive.attributes, "JOINTS_" + std::to_string(set));
        const int weights = attribute(primitive.attributes, "WEIGHTS_" + std::to_string(set));
        if (joints < 0 || weights < 0) return sets;
        Influences next{read_vectors<vec4>(document, joints),
                        read_vectors<vec4>(document, weights)};
        if (next.joints.size() != vertex_count || next.weights.size() != vertex_count) return {};
        sets.push_back(std::move(next));
    }
}

// The weighted sum of the joints of one vertex; a weightless vertex follows no joint.
std::optional<dmat4> blend(const std::vector<Influences>& sets, std::size_t vertex,
                           const std::vector<dmat4>& joints) {
    dmat4 sum(0.0);
    double total = 0;
    for (const Influences& set : sets) {
        for (int k = 0; k < 4; ++k) {
            const double weight = set.weights[vertex][k];
            const float joint = set.joints[vertex][k];
            if (!(weight > 0)) continue;
            if (!(joint >= 0 && joint < static_cast<float>(joints.size()))) return std::nullopt;
            sum += joints[static_cast<std::size_t>(joint)] * weight;
            total += weight;
        }
    }
    if (!std::isfinite(total)) return std::nullopt;
    return total > 0 ? sum / total : dmat4(1.0);
}

void transform_vertex(const dmat4& matrix, Vertices& vertices, std::size_t i) {
    const dmat3 linear(matrix);
    vertices.positions[i] = dvec3(matrix * dvec4(vertices.positions[i], 1));
    if (!vertices.normals.empty()) {
        // The cofactor matrix: the inverse transpose up to a factor, and defined for flat matrices.
        const dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
        const double side = glm::determinant(linear) < 0 ? -1.0 : 1.0;
        vertices.normals[i] = side * (cofactor * vertices.normals[i]);
    }
    if (!vertices.tangents.empty()) {
        vertices.tangents[i] = dvec4(linear * dvec3(vertices.tangents[i]), vertices.tangents[i].w);
    }
}

}  // namespace

void apply_morph_targets(Document& document, const tinygltf::Primitive& primitive,
                         const std::vector<double>& weights, Vertices& vertices) {
    const std::size_t count = std::min(weights.size(), primitive.targets.size());
    for (std::size_t t = 0; t < count; ++t) {
        const auto& target = primitive.targets[t];
        const double w = weights[t];
        if (w == 0) continue;
        add_target<vec3>(document, attribute(target, "POSITION"), w, vertices.positions);
        add_target<vec3>(document, attribute(target, "NORMAL"), w, vertices.normals);
        add_target<vec3>(document, attribute(target, "TANGENT"), w, vertices.tangents);
        add_target<vec2>(document, attribute(target, "TEXCOORD_0"), w, vertices.texcoords[0]);
        add_target<vec2>(document, attribute(target, "TEXCOORD_1"), w, vertices.texcoords[1]);
        const int color = attribute(target, "COLOR_0");
        if (color < 0) continue;
        if (component_count(document, color) == 3) {
            add_target<vec3>(document, color, w, vertices.colors);
        } else {
            add_target<vec4>(document, color, w, vertices.colors);
        }
    }
}

bool apply_skin(Document& document, const tinygltf::Primitive& primitive,
                const std::vector<dmat4>& joints, Vertices& vertices) {
    const std::vector<Influences> sets =
        read_influences(document, primitive, vertices.positions.size());
    std::vector<dmat4> matrices;
    for (std::size_t i = 0; !sets.empty() && i < vertices.positions.size(); ++i) {
        const std::optional<dmat4> matrix = blend(sets, i, joints);
        if (!matrix) break;
        matrices.push_back(*matrix);
    }
    if (matrices.size() != vertices.positions.size()) {
        warn(document, "a skin's joints or weights are unusable; its mesh is shown unposed");
        return false;
    }
    for (std::size_t i = 0; i < matrices.size(); ++i) transform_vertex(matrices[i], vertices, i);
    return true;
}

void transform_vertices(const dmat4& matrix, Vertices& vertices) {
    for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
        transform_vertex(matrix, vertices, i);
    }
}

}  // namespace midway::gltf
