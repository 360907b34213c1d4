// One primitive of a glTF mesh into a Mesh: attributes, morph targets, skin, triangles; then what a
// renderer cannot use is taken out. Internal to renderer/io.
#pragma once

#include <optional>

#include "io/gltf_document.h"
#include "scene/scene_description.h"

namespace midway::gltf {

// The vertices of a primitive while they are being changed, in double: a deformed mesh may lie far
// from the origin of the file.
struct Vertices {
    std::vector<dvec3> positions;
    std::vector<dvec3> normals;   // empty or as long
    std::vector<dvec4> tangents;  // empty or as long
    std::array<std::vector<vec2>, 2> texcoords;
    std::vector<vec4> colors;
};

// How one use of a mesh differs from the mesh.
struct Deformation {
    std::vector<double> weights;  // of morph targets
    std::vector<dmat4> joints;    // world times inverse bind matrix; empty: no skin
    std::optional<dmat4> bake;    // to world, where it cannot stay a transform of the instance
};

// The primitive as a mesh, or nothing (with a warning) where no triangle is left. `tangents_from`
// is the set of texture coordinates of a normal map, -1: none.
struct BuiltMesh {
    Mesh mesh;
    std::optional<dvec3> world_origin;  // set: the mesh is in world space less this
};
std::optional<BuiltMesh> build_mesh(Document& document, const tinygltf::Primitive& primitive,
                                    const Deformation& deformation, int tangents_from,
                                    const std::string& name);

// gltf_deform.cpp. Adds the weighted morph targets of the primitive.
void apply_morph_targets(Document& document, const tinygltf::Primitive& primitive,
                         const std::vector<double>& weights, Vertices& vertices);
// Moves the vertices into the pose of the joints. False with a warning where the skin is unusable.
bool apply_skin(Document& document, const tinygltf::Primitive& primitive,
                const std::vector<dmat4>& joints, Vertices& vertices);
// Applies one matrix to all vertices.
void transform_vertices(const dmat4& matrix, Vertices& vertices);

// gltf_clean.cpp. Drops triangles that are not finite or have no area, replaces unusable normals
// and tangents, drops vertices that no triangle uses. Each kind is one counted warning.
void clean_mesh(Document& document, const std::string& name, Mesh& mesh);

// The accessor of an attribute, -1 where absent.
int attribute(const std::map<std::string, int>& attributes, const std::string& name);

}  // namespace midway::gltf
