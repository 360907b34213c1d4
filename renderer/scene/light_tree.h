// Which lamp next event asks, where there may be a hundred thousand: a tree over all lights of
// finite distance (Conty Estevez & Kulla 2018, "Importance Sampling of Many Lights with Adaptive
// Tree Splitting"). From the root down, one of up to eight children is taken in proportion to a
// guess at what its lights send to the reference point: power, over the distance squared, times a
// bound on the cosine at the lights. The guess knows neither what is in the way nor how the surface
// scatters, so a share of the picks goes by weight alone. Densities in the MIS weights need the
// same product for a light that somebody else found: probability() walks down the same way.
//
// The shape of the tree follows from places and directions alone, so that it survives edits of how
// strongly lights shine, and every edit ends at the tree that loading would have built.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/distribution.h"
#include "math/lanes.h"

namespace midway {

// A light as the tree sees it.
struct LightBounds {
    vec3 lower{0}, upper{0};
    vec3 axis{0, 0, 1};      // unit; it sends most along this
    bool everywhere = true;  // or in no direction more than in others
};

class LightTree {
  public:
    // The probability of a light without regard to the reference point is in proportion to its
    // weight; zero: it is never taken. One bounds and one weight for each light.
    void build(const std::vector<LightBounds>& lights, const std::vector<double>& weights);

    // The same shape with other weights, for lights of the same places and directions; those whose
    // weight is zero must be the same too.
    void reweigh(const std::vector<double>& weights);

    // u in [0, 1) with as many bits as there are lights to tell apart. -1 where the tree is empty.
    int sample(const vec3& reference, double u, double& probability) const;
    double probability(int light, const vec3& reference) const;

    // sample() for eight places, one in each lane that is wanted. They go down the tree side by
    // side, so that the memory is asked for eight nodes at once and not for one after the other.
    struct Picks {
        std::array<int, lane_count> light;
        std::array<double, lane_count> probability;
    };
    void sample(const Vec3x8& reference, const Double8& u, const Mask8& wanted, Picks& picks) const;

    // probability() of a light for each of eight places.
    std::array<double, lane_count> probabilities(const std::array<int, lane_count>& lights,
                                                 const Vec3x8& reference,
                                                 const Mask8& wanted) const;

    // The one light to take, where there are no others; -1: there are none, or several.
    int only() const { return only_; }

    bool operator==(const LightTree&) const = default;

  private:
    static constexpr int width = 8;
    static constexpr double share_by_weight = 0.25;
    // Eight children side by side, so that they are weighed together.
    struct alignas(32) Node {
        using Lane = std::array<float, width>;
        Lane x{}, y{}, z{};                 // centres of bounds
        Lane radius{};                      // half their diagonals
        Lane axis_x{}, axis_y{}, axis_z{};  // zero: in all directions
        Lane spread{};  // sine of the widest angle about the axis; 1 or more: all
        Lane weight{};
        std::array<std::int32_t, width> child{};  // a node; ~light for a leaf; 0: none
        bool operator==(const Node&) const = default;
    };
    friend struct LightTreeBuilder;

    // What each child counts for at a place; returns the sum, above zero.
    static float weigh(const Node& node, const vec3& reference, Node::Lane& shares);

    // On the way down the tree: to a place that u chooses, or along the turns to a light.
    struct Descent {
        vec3 reference{0};
        double u = 0;
        double probability = 1;
        std::uint64_t turns = 0;  // that are left, as in turns_; 0: u chooses
        std::int32_t node = 0;    // ~light where it has ended
    };
    Descent begin(const vec3& reference, double u) const;
    bool step(Descent& d) const;  // false: it has ended
    double probability_of(const Descent& d) const;
    void go_down(std::array<Descent, lane_count>& descents, const Mask8& wanted) const;
    Descent along(int light, const vec3& reference) const;

    int only_ = -1;
    Distribution1D by_weight_;
    std::vector<Node> nodes_;  // parents before their children
    // The way to each light: three bits a level, the root's lowest, and a 1 above all; 0: none.
    std::vector<std::uint64_t> turns_;
};

}  // namespace midway
