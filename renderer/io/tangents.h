// Tangents for meshes that have a normal map but no TANGENT attribute, in the manner of MikkTSpace
// (M. Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008): each corner adds its triangle's
// tangent, projected into the plane of the vertex normal and weighted by the corner's angle, to all
// corners of equal position, normal, texture coordinate and handedness. In glTF's convention
// (v points down) the bitangent cross(normal, tangent.xyz) * tangent.w points towards smaller v.
#pragma once

#include "scene/scene_description.h"

namespace midway {

// Fills mesh.tangents from texcoords[texcoord], which must be as long as the positions. Vertices
// that triangles of both handedness share are doubled. Where the mesh has no normals every corner
// becomes a vertex of its own, with the triangle's normal as the plane of its tangent; normals stay
// empty.
void generate_tangents(Mesh& mesh, int texcoord);

}  // namespace midway
