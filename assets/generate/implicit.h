// Implicit surfaces: bodies given by a function that is negative inside, grows outward and has a
// slope near one by the surface (distance-like), and their triangulation.
#pragma once

#include <functional>

#include "mesh.h"

namespace midway::assets {

using Field = std::function<double(const dvec3&)>;

// Distance bounds and blends (after Quilez, "Distance functions" and "Smooth minimum"); `width` is
// the size of the rounding where two bodies meet.
double ellipsoid(const dvec3& p, const dvec3& radii);
double capsule(const dvec3& p, const dvec3& a, const dvec3& b, double radius_a, double radius_b);
double joined(double a, double b, double width);
double carved(double body, double tool, double width);
double intersected(double a, double b, double width);

struct PolygoniseSettings {
    dvec3 low{-1}, high{1};  // the body lies strictly inside
    double cell = 0.1;
    int relaxations = 12;
};

// A closed mesh of nearly equal triangles whose vertices lie on the surface and whose normals are
// the field's gradient: surface nets (Gibson 1998), relaxed along the surface, projected by Newton
// steps.
Mesh polygonise(const Field& field, const PolygoniseSettings& settings);

}  // namespace midway::assets
