// Triangle meshes of the project's own scenes and the simple solids they are made of. Metres, y up,
// fronts wind counter-clockwise. Everything is computed in double and rounded to float on writing.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace midway::assets {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::uvec3;

inline constexpr double pi = 3.14159265358979323846;

struct Mesh {
    std::vector<dvec3> positions;
    std::vector<dvec3> normals;  // unit, as long as positions
    std::vector<uvec3> triangles;
};

dmat4 translation(const dvec3& offset);
dmat4 rotation(const dvec3& axis, double degrees);
dmat4 scaling(const dvec3& factors);  // all positive
// Where a camera or spot lamp stands: origin at `eye`, -z towards `target`.
dmat4 looking_at(const dvec3& eye, const dvec3& target, const dvec3& up = {0, 1, 0});

void append(Mesh& mesh, const Mesh& other);
Mesh transformed(const Mesh& mesh, const dmat4& to_world);  // rotations, positive scales
Mesh turned_inside_out(const Mesh& mesh);

// Flat polygons; the front is where a, b, c, d run counter-clockwise.
Mesh quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
Mesh box(const dvec3& low, const dvec3& high);
// A box around the origin with rounded edges; one smooth closed surface.
Mesh rounded_box(const dvec3& half_extent, double radius, int segments);
// Regular icosahedron, each triangle split into 4^subdivisions, on the unit sphere about the
// origin.
Mesh icosphere(double radius, int subdivisions);

// Surface of revolution about +y. Profile points are (radius, height), the outside to the right of
// the walk (so an outer wall runs upward). A point given twice is a sharp edge. Points on the axis
// are poles. `closed` joins the last point to the first (a ring).
Mesh lathe(const std::vector<dvec2>& profile, int segments, bool closed = false);
// Profile of a disc-shaped block with rounded rims, standing on y = 0; for lathe().
std::vector<dvec2> block_profile(double radius, double height, double bevel, int bevel_segments);
Mesh cylinder(double radius, double height, double bevel, int segments);
Mesh torus(double radius, double tube_radius, int segments, int tube_segments);
// A round tube along a curve, closed with flat ends.
Mesh tube(const std::vector<dvec3>& curve, double radius, int segments);

// Squares of alternating colour in y = 0: half of the board; `odd` chooses which.
Mesh checker_half(const dvec2& low, const dvec2& high, int columns, int rows, bool odd);

// Throws where the mesh is not what a renderer may expect: index out of range, degenerate triangle
// after rounding to float, normal not unit or against the winding; with `closed` also an open or
// non-manifold edge, a vertex where two sheets meet, or a volume turned inside out.
void check_mesh(const Mesh& mesh, const std::string& name, bool closed);

// Random numbers that are the same everywhere (Steele et al. 2014, splitmix64).
struct Random {
    std::uint64_t state = 0;
    double next();                            // [0, 1)
    double between(double low, double high);  // uniform
    int below(int count);                     // 0 .. count-1
};

}  // namespace midway::assets
