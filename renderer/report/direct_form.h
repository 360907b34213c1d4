// MIS weights by the direct product form, eq. (4)-(10) of the seed document ("Practical
// implementation of MIS in Bidirectional Path Tracing"), in logarithms and long double. It shares
// no code with integrator/mis.h, which the audit and the tests judge by it.
//
// A path of k edges has vertices 0 (lens) to k (light). Vertex i is made from the camera's side
// with density camera_w * camera_g and from the light's side with light_w * light_g, eq. (1)-(3),
// (5)-(7); w is per solid angle (behind a delta vertex the coefficient of its Dirac factor), g =
// cos / d^2 at the vertex. An infinite light's vertex k is a direction: camera_g[k] = 1,
// light_g[k-1] = cos (35-38).
#pragma once

#include <vector>

#include "integrator/strategy.h"

namespace midway {

struct Estimator;

struct VertexPdfs {
    double camera_w = 1,
           camera_g = 1;              // of this vertex, made from its neighbour towards the camera
    double light_w = 1, light_g = 1;  // made from its neighbour towards the light
    bool delta = false;               // the path scatters here by a delta lobe
};

// Every pdf of a whole path.
struct PathPdfs {
    std::vector<VertexPdfs> vertices;
    double emission = 1;    // density of vertex k where a light subpath starts
    double next_event = 1;  // where next event chooses it
    bool hittable = true;   // not a delta light

    int edges() const { return static_cast<int>(vertices.size()) - 1; }
    double from_camera(int i) const { return vertices[i].camera_w * vertices[i].camera_g; }
    double from_light(int i) const { return vertices[i].light_w * vertices[i].light_g; }
};

// What decides about feasibility and numbers of samples apart from the path.
struct PathSetting {
    Families families;
    double light_subpaths = 1;
    int max_bounces = 1000;
    double direct_share = 1, connection_share = 1;  // as in Estimator
    int direct_samples = 1;
    int choices = 1;
};
PathSetting path_setting(const Estimator& estimator);

// n of eq. (22) for light tracing, and for next event.
double light_tracing_count(const PathSetting& setting, int edges);
int next_event_count(const PathSetting& setting, int edges);
// The same for a connection whose last camera vertex is the first rough surface, or is not.
double connection_count(const PathSetting& setting, bool first);

// Whether no vertex between the lens and vertex i is rough: all scatter by delta lobes.
bool is_first_rough(const PathPdfs& path, int i);

// Can this strategy make the path at all? (2,0) and (1,1) are no strategies of weighted paths.
bool is_feasible(const PathPdfs& path, const Strategy& strategy, const PathSetting& setting);

// log(n p) of eq. (9) with the number of samples of eq. (22); -infinity where not feasible.
long double log_density(const PathPdfs& path, const Strategy& strategy, const PathSetting& setting);

// The same for every strategy of a path of k edges, at least two: element s - 1 belongs to
// (s, k + 1 - s).
std::vector<long double> log_densities(const PathPdfs& path, const PathSetting& setting);

// Eq. (10) for every strategy. All zero where no strategy is feasible.
std::vector<double> direct_weights(const std::vector<long double>& log_densities, double exponent);
std::vector<double> direct_weights(const PathPdfs& path, const PathSetting& setting,
                                   double exponent);

}  // namespace midway
