#include "io/gltf_nodes.h"

#include <algorithm>
#include <cmath>

namespace midway::gltf {
namespace {

constexpr int no_parent = -1;

dvec3 vector_or(const std::vector<double>& values, const dvec3& otherwise) {
    return values.size() == 3 ? dvec3(values[0], values[1], values[2]) : otherwise;
}

dmat4 local_matrix(Document& document, int index) {
    const tinygltf::Node& node = document.model.nodes[static_cast<std::size_t>(index)];
    if (node.matrix.size() == 16) {
        dmat4 out;
        for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
        const dvec4 bottom(out[0].w, out[1].w, out[2].w, out[3].w);
        if (bottom != dvec4(0, 0, 0, 1)) {
            warn(document, "the matrix of node " + std::to_string(index) +
                               " is not affine; its last row is ignored");
            out[0].w = out[1].w = out[2].w = 0;
            out[3].w = 1;
        }
        return out;
    }
    const std::vector<double>& r = node.rotation;
    const dvec4 rotation = r.size() == 4 ? dvec4(r[0], r[1], r[2], r[3]) : dvec4(0, 0, 0, 1);
    return compose(vector_or(node.translation, dvec3(0)), rotation,
                   vector_or(node.scale, dvec3(1)));
}

// The parent of each node. A node that several claim belongs to the first.
std::vector<int> find_parents(Document& document) {
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    std::vector<int> parents(nodes.size(), no_parent);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        for (const int child : nodes[n].children) {
            at(document, nodes, child, "node");
            int& parent = parents[static_cast<std::size_t>(child)];
            if (parent == no_parent) {
                parent = static_cast<int>(n);
            } else {
                warn(document, "node " + std::to_string(child) +
                                   " has several parents; it is shown below the first only");
            }
        }
    }
    return parents;
}

// Nodes with parents before children. Throws where a node is its own ancestor.
std::vector<int> topological_order(const Document& document, const std::vector<int>& parents) {
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    std::vector<int> order;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (parents[n] == no_parent) order.push_back(static_cast<int>(n));
    }
    std::vector<char> placed(nodes.size(), 0);
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (const int child : nodes[static_cast<std::size_t>(order[i])].children) {
            const auto c = static_cast<std::size_t>(child);
            if (parents[c] != order[i] || placed[c]) continue;
            placed[c] = 1;
            order.push_back(child);
        }
    }
    if (order.size() != nodes.size()) fail(document.path, "the node hierarchy contains a loop");
    return order;
}

std::vector<int> scene_roots(Document& document, const std::vector<int>& parents) {
    const tinygltf::Model& model = document.model;
    if (!model.scenes.empty()) {
        const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
        return at(document, model.scenes, scene, "scene").nodes;
    }
    std::vector<int> roots;
    for (std::size_t n = 0; n < parents.size(); ++n) {
        if (parents[n] == no_parent) roots.push_back(static_cast<int>(n));
    }
    return roots;
}

std::vector<int> shown_nodes(Document& document, const std::vector<int>& parents) {
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    std::vector<char> seen(nodes.size(), 0);
    std::vector<int> shown;
    for (const int root : scene_roots(document, parents)) {
        at(document, nodes, root, "node");
        std::vector<int> stack = {root};
        while (!stack.empty()) {
            const int node = stack.back();
            stack.pop_back();
            if (seen[static_cast<std::size_t>(node)]) continue;
            seen[static_cast<std::size_t>(node)] = 1;
            shown.push_back(node);
            const std::vector<int>& children = nodes[static_cast<std::size_t>(node)].children;
            for (auto it = children.rbegin(); it != children.rend(); ++it) {
                if (parents[static_cast<std::size_t>(*it)] == node) stack.push_back(*it);
            }
        }
    }
    return shown;
}

}  // namespace

NodeTree build_node_tree(Document& document) {
    const std::vector<int> parents = find_parents(document);
    NodeTree tree;
    tree.to_world.resize(parents.size());
    for (const int node : topological_order(document, parents)) {
        const auto n = static_cast<std::size_t>(node);
        const dmat4 local = local_matrix(document, node);
        const int parent = parents[n];
        tree.to_world[n] =
            parent == no_parent ? local : tree.to_world[static_cast<std::size_t>(parent)] * local;
    }
    tree.shown = shown_nodes(document, parents);
    return tree;
}

dmat4 compose(const dvec3& translation, const dvec4& rotation, const dvec3& scale) {
    const double length = std::sqrt(glm::dot(rotation, rotation));
    const bool usable = length > 0 && std::isfinite(length);
    const dvec4 q = usable ? rotation / length : dvec4(0, 0, 0, 1);
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    dmat4 out(1.0);
    out[0] = dvec4(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0) * scale.x;
    out[1] = dvec4(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0) * scale.y;
    out[2] = dvec4(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0) * scale.z;
    out[3] = dvec4(translation, 1);
    return out;
}

bool usable_matrix(const dmat4& matrix) {
    constexpr double largest = 1e18;
    for (int i = 0; i < 16; ++i) {
        if (!(std::abs(matrix[i / 4][i % 4]) <= largest)) return false;
    }
    return true;
}

std::string node_name(const Document& document, int node) {
    const std::string& name = document.model.nodes[static_cast<std::size_t>(node)].name;
    return name.empty() ? "node " + std::to_string(node) : printable(name);
}

}  // namespace midway::gltf
