// One sample of a pixel, computed again alone and written out in full: both subpaths, and for every
// full path that it found the densities and weights of all strategies that could have found it. For
// the path inspector, --debug-pixel and bug reports.
//
// Positions, densities per area and fluxes are in the file's units. What a contribution put into
// the films is exact: `fixed` are the very integers that the film added.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/recording.h"
#include "report/drawn_path.h"

namespace midway {

enum class VertexKind { camera, surface, point_light, spot_light, sun, area_light, sky, nothing };

// "camera", "surface", "point light" ...
const char* to_string(VertexKind kind);

// None: there is no such density (yet); probability: Dirac factors are left out (points, suns).
enum class Measure { none, per_area, per_solid_angle, probability };
struct Density {
    double value = 0;
    Measure measure = Measure::none;
};

// A vertex of a subpath; element 0 is the lens or the light.
struct InspectedVertex {
    VertexKind kind = VertexKind::surface;
    dvec3 position{0};      // where `infinite`, a unit vector towards it
    bool infinite = false;  // a light infinitely far away, or nothing at all
    vec3 normal{0};         // geometric, of the front; zero without a surface
    int object = -1;        // of the scene's geometry
    std::string object_name, material_name;
    bool connectible = false;  // false: all of its lobes are delta, or it has none
    bool black = false;        // it scatters nothing
    bool shines = false;
    bool delta = false;   // the walk went on by a delta lobe
    float roughness = 0;  // as glTF has it: the root of the GGX width; 1 where only diffuse
    // With which this vertex is made by its predecessor in the walk, and by its successor where the
    // walk has one.
    Density fwd, rev;
    // Of the direction in which the walk went on, and of the way back.
    Density scatter_fwd, scatter_rev;
    vec3 throughput{0};  // of the subpath up to here
};

// One strategy for a full path.
struct InspectedStrategy {
    Strategy strategy;
    bool feasible = false;
    double log10_pdf = 0;  // of n p, eq. (9); minus infinity where not feasible
    // By the recursion (the render's own for the strategy that found the path) and by the direct
    // form, eq. (4)-(10); one of each per exponent.
    std::vector<double> weights, direct;
    vec3 value{0};  // f / (n p): its bare estimate, had it found this path
};

// A full path that the sample found, and what it gave.
struct InspectedPath {
    Contribution contribution;  // as the render formed it
    bool splat = false;
    int x = 0, y = 0;             // where it went
    bool usable = true;           // finite: what is not is counted and reaches no film
    bool clamped = false;         // for the first exponent
    std::vector<vec3> recorded;   // per exponent, as it reached the film
    std::vector<FixedRgb> fixed;  // the same in units of 2^InspectedSample::unit_exponent
    std::vector<InspectedStrategy> strategies;  // by number of camera vertices, those of the length
    // From the lens to the light. The last one is a unit vector towards it where `infinite`.
    std::vector<dvec3> points;
    bool infinite = false;
    InspectedVertex light_end;  // what the path ends on
    // Of a connection to a neighbour's light subpath: which of InspectedSample::neighbours.
    std::optional<size_t> neighbour;
};

// A light subpath that belongs to the sample of a neighbouring pixel, which shares it.
struct NeighbourSubpath {
    int x = 0, y = 0;
    std::uint64_t number = 0;
    std::vector<InspectedVertex> vertices;  // from the light on
};

struct InspectedSample {
    int x = 0, y = 0;
    std::uint64_t pass = 0;
    std::optional<std::uint64_t> light_subpath;  // the one it is paired with; not every one is
    std::vector<double> exponents;
    int unit_exponent = 0;
    std::vector<InspectedVertex> camera, light;  // the subpaths, from their own ends on
    std::vector<NeighbourSubpath> neighbours;    // those that it connected to
    std::vector<InspectedPath> paths;            // in the order in which they were found
};

// The light subpath that a path is made with: the sample's own, also without a path, or a
// neighbour's.
const std::vector<InspectedVertex>& light_subpath_of(const InspectedSample& sample,
                                                     const InspectedPath* path);

// What a sample belongs to: a scene seen by a camera with some settings.
struct Inspectable {
    std::shared_ptr<const Scene> scene;
    CameraDescription camera;
    RenderSettings settings;
};

// Sample number `pass` of a pixel, which must lie in the crop. Throws as make_estimator().
InspectedSample inspect_sample(const Inspectable& what, int x, int y, std::uint64_t pass);

// What a sample gave to a pixel, per exponent.
std::vector<vec3> recorded_in(const InspectedSample& sample, int x, int y);

}  // namespace midway
