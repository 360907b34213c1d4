// A triangle as the sphere about a point sees it: its solid angle, and directions spread evenly
// over it (Arvo 1995, "Stratified sampling of spherical triangles"). A lamp close by is drawn this
// way: by area, what it sends would vary as cos / d^2 over the lamp.
#pragma once

#include "math/vector.h"

namespace midway {

// Vertices relative to the point; none of them is zero.
struct TriangleFrom {
    dvec3 a{0}, b{0}, c{0};
};

// Steradians (Van Oosterom & Strackee 1983); zero where the point lies in the triangle's plane.
double solid_angle(const TriangleFrom& t);

// Barycentric weights of vertices b and c, in the triangle, of the point in the sampled direction:
// uniform in solid angle. `solid_angle` is the triangle's, above zero.
dvec2 sample_solid_angle(const TriangleFrom& t, double solid_angle, const vec2& u);

}  // namespace midway
