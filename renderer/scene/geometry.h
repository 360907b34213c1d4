// Triangles as they are traced: in scene space, that is recentred (in double) and scaled by a power
// of two so that the bounding radius lies in [0.5, 1). Nothing here is edited after it is built.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "math/vector.h"
#include "shading/texture.h"

namespace midway {

// The triangles of one instance of a mesh. Attribute arrays are empty or as long as `positions`;
// texture coordinates and tangents are there only where the material has a texture that asks for
// them.
struct Object {
    std::string name;
    int instance = 0;  // of the description
    int material = 0;
    std::vector<vec3> positions;
    std::vector<vec3> normals;
    std::vector<vec4> tangents;
    std::array<std::vector<vec2>, 2> texcoords;
    std::vector<vec4> colors;
    std::vector<uvec3> triangles;  // counter-clockwise seen from the front
    bool closed = false;           // every edge is shared by two triangles in opposite directions
    bool may_be_transparent = false;  // alpha below 1 somewhere
};

// scene = (file - center) * scale, scale a power of two.
struct Normalisation {
    dvec3 center{0};
    double scale = 1;
};

struct Geometry {
    std::vector<Object> objects;
    Normalisation normalisation;
    float radius = 1;  // of all positions about the origin, in [0.5, 1); 1 where there are none
    size_t triangle_count = 0;
    size_t dropped = 0;         // triangles that have no area left in float
    size_t duplicates = 0;      // triangles left out because they are there already
    size_t spared_objects = 0;  // that have attributes in the file, and no texture asks for them
};

// Where a ray met a triangle: b1 and b2 are the barycentric weights of its vertices 1 and 2.
struct TriangleHit {
    int object = -1;
    int triangle = -1;
    float b1 = 0, b2 = 0;
};

// A point on a surface with what its material needs.
struct SurfacePoint {
    vec3 position{0};
    float error = 0;  // bound on the distance of `position` from the triangle as Embree sees it
    TriangleHit hit;
    ShadingPoint shading;
};

SurfacePoint surface_point(const Object& object, TriangleHit hit);

// The part of it that needs no attributes.
struct TrianglePoint {
    vec3 position{0};
    float error = 0;
    vec3 ng{0, 0, 1};
};
// What that takes, side by side.
struct FlatTriangle {
    vec3 v0{0}, v1{0}, v2{0}, ng{0, 0, 1};
    float extent = 0;  // largest component of its edges from v0
};
FlatTriangle flat_triangle(const Object& object, int triangle);
TrianglePoint triangle_point(const FlatTriangle& t, float b1, float b2);

// The origin of a ray that leaves `position` on the side of ng that `towards` points to, far enough
// for the ray not to meet the surface it left (error bound of the hit; no absolute epsilon).
vec3 offset_origin(const vec3& position, const vec3& ng, float error, const vec3& towards);

// Where a ray from `from` (its place before any offset) to a point on a surface ends without
// meeting it. A triangle is tested relative to the ray's origin, so at this end rounding grows with
// the ray's length too.
vec3 offset_end(const vec3& position, const vec3& ng, float error, const vec3& from);

struct TriangleShape {
    vec3 normal{0};  // unit, of the front
    float area = 0;
};
TriangleShape triangle_shape(const Object& object, int triangle);

// Whether every edge has as many triangles in one direction as in the other; vertices at the same
// place are one. A sum of hashes over the directed edges: linear time, and a mesh that is open
// passes for closed once in 2^64.
bool is_closed_mesh(const std::vector<vec3>& positions, const std::vector<uvec3>& triangles);

}  // namespace midway
