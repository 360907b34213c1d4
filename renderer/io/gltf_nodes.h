// The node hierarchy: world matrices in double and the nodes that the scene shows. Internal to
// renderer/io. Throws std::runtime_error for loops and nodes that do not exist.
#pragma once

#include <vector>

#include "io/gltf_document.h"
#include "scene/scene_description.h"

namespace midway::gltf {

struct NodeTree {
    std::vector<dmat4> to_world;  // of every node of the file
    std::vector<int> shown;       // nodes of the default scene, parents before children
};

NodeTree build_node_tree(Document& document);

// T * R * S in double; `rotation` is a quaternion x, y, z, w and need not be of unit length.
dmat4 compose(const dvec3& translation, const dvec4& rotation, const dvec3& scale);

// Whether all elements are finite and small enough for the renderer's floats.
bool usable_matrix(const dmat4& matrix);

// The cameras and lights that a shown node carries.
void add_camera(Document& document, int node, const dmat4& to_world, SceneDescription& scene);
void add_light(Document& document, int node, const dmat4& to_world, SceneDescription& scene);

// World matrices of the node's mesh: one, or one per instance of EXT_mesh_gpu_instancing.
std::vector<dmat4> mesh_transforms(Document& document, int node, const dmat4& to_world);

std::string node_name(const Document& document, int node);

}  // namespace midway::gltf
