#include "scene/light_tree.h"

#include <algorithm>
#include <limits>

namespace midway {
namespace {

// The least share of its unoriented importance that a cluster keeps: the bound on the cosine is a
// guess, and a light that it hides would be noise.
constexpr float least_cosine = 0.03f;

// A cone of directions about a unit axis.
struct Cone {
    vec3 axis{0, 0, 1};
    float half = 0;  // angle; pi: all directions
};

// A cone about both that is not much larger than need be.
Cone join(const Cone& a, const Cone& b) {
    if (a.half >= pi || b.half >= pi) return {a.axis, pi};
    const float between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.0f, 1.0f));
    if (between + b.half <= a.half) return a;
    if (between + a.half <= b.half) return b;
    const float half = 0.5f * (a.half + between + b.half);
    const vec3 ortho = b.axis - a.axis * glm::dot(a.axis, b.axis);
    const float length = glm::length(ortho);
    if (half >= pi || !(length > 0)) return {a.axis, pi};
    const float turn = half - a.half;  // from a's axis towards b's
    return {glm::normalize(a.axis * std::cos(turn) + ortho * (std::sin(turn) / length)), half};
}

// In pairs: additions that do not wait for each other.
float sum_of(const std::array<float, 8>& x) {
    return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

}  // namespace

struct LightTreeBuilder {
    const std::vector<LightBounds>& lights;
    LightTree& tree;
    std::vector<int> order;

    struct Bounds {
        vec3 lower{0}, upper{0};
        Cone axes;
    };

    vec3 centre(int light) const { return 0.5f * (lights[light].lower + lights[light].upper); }

    // The axis along which the centres of order[begin, end) extend most, and from where to where.
    struct Extent {
        int axis = 0;
        float lower = 0, length = 0;
    };
    Extent longest_extent(int begin, int end) const {
        vec3 lower = centre(order[begin]), upper = lower;
        for (int i = begin; i < end; ++i) {
            lower = glm::min(lower, centre(order[i]));
            upper = glm::max(upper, centre(order[i]));
        }
        const vec3 side = upper - lower;
        const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
        return {axis, lower[axis], side[axis]};
    }

    // Orders order[begin, end) so that its halves lie on two sides of the longest extent; the place
    // where the second begins.
    int split_in_half(int begin, int end, int axis) {
        const int middle = begin + (end - begin) / 2;
        const auto before = [&](int a, int b) {
            const float x = centre(a)[axis], y = centre(b)[axis];
            return x < y || (x == y && a < b);  // one order, also for equal places
        };
        std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                         before);
        return middle;
    }

    static constexpr int bins = 16;
    static int bin_of(const Extent& e, const vec3& centre) {
        return std::min(bins - 1, static_cast<int>(bins * ((centre[e.axis] - e.lower) / e.length)));
    }

    // The bin that the second part should begin with: where lights times the squared size of what
    // bounds them is least, so that lamps far from all others end up in parts of their own.
    int best_bin(int begin, int end, const Extent& e) const {
        constexpr float inf = std::numeric_limits<float>::infinity();
        struct Part {
            vec3 lower{inf}, upper{-inf};
            int count = 0;
            void add(const Part& p) {
                lower = glm::min(lower, p.lower);
                upper = glm::max(upper, p.upper);
                count += p.count;
            }
            float cost() const {
                return count ? static_cast<float>(count) * length_squared(upper - lower) : 0;
            }
        };
        std::array<Part, bins> parts;
        for (int i = begin; i < end; ++i) {
            const LightBounds& l = lights[order[i]];
            parts[bin_of(e, centre(order[i]))].add({l.lower, l.upper, 1});
        }
        std::array<float, bins> above{};  // cost of the bins from this one on
        Part sum;
        for (int k = bins - 1; k > 0; --k) {
            sum.add(parts[k]);
            above[k] = sum.cost();
        }
        int best = 1;
        float least = inf;
        sum = {};
        for (int k = 1; k < bins; ++k) {
            sum.add(parts[k - 1]);
            const float cost = sum.cost() + above[k];
            if (cost < least) {
                least = cost;
                best = k;
            }
        }
        return best;
    }

    // The place where the second part of order[begin, end) begins, once it is ordered.
    int split(int begin, int end, bool evenly) {
        const Extent e = longest_extent(begin, end);
        if (evenly || !(e.length > 0)) return split_in_half(begin, end, e.axis);
        const int bin = best_bin(begin, end, e);
        const auto middle =
            std::stable_partition(order.begin() + begin, order.begin() + end,
                                  [&](int light) { return bin_of(e, centre(light)) < bin; });
        const int at = static_cast<int>(middle - order.begin());
        return at > begin && at < end ? at : split_in_half(begin, end, e.axis);
    }

    // Ends of up to eight parts of order[begin, end).
    std::vector<int> parts(int begin, int end, bool evenly) {
        std::vector<int> ends{begin, end};
        for (int round = 0; round < 3; ++round) {
            std::vector<int> finer{begin};
            for (size_t i = 1; i < ends.size(); ++i) {
                if (ends[i] - ends[i - 1] > 1) finer.push_back(split(ends[i - 1], ends[i], evenly));
                finer.push_back(ends[i]);
            }
            ends = std::move(finer);
        }
        return ends;
    }

    // `way`: the turns that lead here, of `level` levels.
    Bounds grow(int begin, int end, std::uint64_t way, int level) {
        const size_t at = tree.nodes_.size();
        tree.nodes_.emplace_back();
        // A way has bits for 20 levels; from the tenth on even parts keep within them.
        const std::vector<int> ends = parts(begin, end, level >= 10);
        Bounds all;
        for (size_t k = 0; k + 1 < ends.size(); ++k) {
            const std::uint64_t further = way | (std::uint64_t{k} << (3 * level));
            const int child =
                ends[k + 1] - ends[k] == 1 ? ~order[ends[k]] : static_cast<int>(tree.nodes_.size());
            Bounds b;
            if (child < 0) {
                const LightBounds& l = lights[~child];
                b = {l.lower, l.upper, {l.axis, l.everywhere ? pi : 0.0f}};
                tree.turns_[~child] = further | (std::uint64_t{1} << (3 * (level + 1)));
            } else {
                b = grow(ends[k], ends[k + 1], further, level + 1);
            }
            put(tree.nodes_[at], k, b, child);
            all = k == 0 ? b
                         : Bounds{glm::min(all.lower, b.lower), glm::max(all.upper, b.upper),
                                  join(all.axes, b.axes)};
        }
        return all;
    }

    static void put(LightTree::Node& n, size_t k, const Bounds& b, int child) {
        const vec3 c = 0.5f * (b.lower + b.upper);
        n.x[k] = c.x;
        n.y[k] = c.y;
        n.z[k] = c.z;
        n.radius[k] = 0.5f * glm::length(b.upper - b.lower);
        const bool all = b.axes.half >= 0.5f * pi;
        const vec3 axis = all ? vec3(0) : b.axes.axis;
        n.axis_x[k] = axis.x;
        n.axis_y[k] = axis.y;
        n.axis_z[k] = axis.z;
        n.spread[k] = all ? 1.0f : std::sin(b.axes.half);
        n.child[k] = child;
    }
};

void LightTree::build(const std::vector<LightBounds>& lights, const std::vector<double>& weights) {
    nodes_.clear();
    turns_.assign(lights.size(), 0);
    LightTreeBuilder b{lights, *this, {}};
    for (size_t i = 0; i < lights.size(); ++i)
        if (weights[i] > 0) b.order.push_back(static_cast<int>(i));
    only_ = b.order.size() == 1 ? b.order.front() : -1;
    if (b.order.empty()) return;
    b.grow(0, static_cast<int>(b.order.size()), 0, 0);
    reweigh(weights);
}

void LightTree::reweigh(const std::vector<double>& weights) {
    by_weight_ = make_distribution(weights);
    for (size_t i = nodes_.size(); i-- > 0;) {
        Node& n = nodes_[i];
        for (int k = 0; k < width; ++k) {
            const std::int32_t child = n.child[k];
            if (child < 0) {
                n.weight[k] = static_cast<float>(by_weight_.probability(~child));
            } else if (child > 0) {
                double sum = 0;
                for (const float w : nodes_[child].weight) sum += w;
                n.weight[k] = static_cast<float>(sum);
            }
        }
    }
}

float LightTree::weigh(const Node& n, const vec3& reference, Node::Lane& shares) {
    constexpr float least = std::numeric_limits<float>::min();
    for (int k = 0; k < width; ++k) {
        const float dx = reference.x - n.x[k], dy = reference.y - n.y[k], dz = reference.z - n.z[k];
        const float d2 = std::max(dx * dx + dy * dy + dz * dz, least);
        const float inverse = 1 / std::sqrt(d2);
        const float cosine = (n.axis_x[k] * dx + n.axis_y[k] * dy + n.axis_z[k] * dz) * inverse;
        // cos(x - y) <= cos x + sin y, for the spread of the axes and the extent of the bounds.
        const float bound = cosine + n.spread[k] + n.radius[k] * inverse;
        // Inside its bounds a cluster is as near as it is large.
        const float near2 = std::max(d2, n.radius[k] * n.radius[k]);
        shares[k] = n.weight[k] * std::min(1.0f, std::max(least_cosine, bound)) / near2;
    }
    const float sum = sum_of(shares);
    if (sum > 0 && std::isfinite(sum)) return sum;
    // Extreme weights or distances: by weight alone.
    shares = n.weight;
    return sum_of(shares);
}

LightTree::Descent LightTree::along(int light, const vec3& reference) const {
    Descent d{.reference = reference, .turns = turns_[light]};
    if (d.turns <= 1) d.node = ~light;
    return d;
}

LightTree::Descent LightTree::begin(const vec3& reference, double u) const {
    if (u < share_by_weight)
        return along(find_interval(by_weight_, u / share_by_weight), reference);
    return {.reference = reference, .u = (u - share_by_weight) / (1 - share_by_weight)};
}

bool LightTree::step(Descent& d) const {
    if (d.node < 0) return false;
    const Node& node = nodes_[d.node];
    Node::Lane shares;
    const double sum = weigh(node, d.reference, shares);
    if (d.turns != 0) {
        const std::uint64_t k = d.turns & 7;
        d.probability *= shares[k] / sum;
        d.turns >>= 3;
        d.node = node.child[k];
        return d.node > 0;
    }
    // All lanes are compared, since nobody foresees where a search would end.
    const double left_of_all = d.u * sum;
    std::array<double, width> begin;
    double end = 0;
    for (int k = 0; k < width; ++k) {
        begin[k] = end;
        end += shares[k];
    }
    int chosen = 0;
    for (int k = 1; k < width; ++k) chosen += begin[k] <= left_of_all;
    while (!(shares[chosen] > 0)) --chosen;  // past the end by rounding
    const double left = left_of_all - begin[chosen];
    d.probability *= shares[chosen] / sum;
    d.u = std::clamp(left / shares[chosen], 0.0, 1 - 0x1p-53);
    d.node = node.child[chosen];
    return d.node > 0;
}

double LightTree::probability_of(const Descent& d) const {
    return share_by_weight * by_weight_.probability(~d.node) +
           (1 - share_by_weight) * d.probability;
}

int LightTree::sample(const vec3& reference, double u, double& probability) const {
    if (only_ >= 0 || nodes_.empty()) {
        probability = 1;
        return only_;
    }
    Descent d = begin(reference, u);
    while (step(d)) {
    }
    probability = probability_of(d);
    return ~d.node;
}

void LightTree::go_down(std::array<Descent, lane_count>& descents, const Mask8& wanted) const {
    for (Mask8 left = wanted; any(left);)
        for_each_lane(left, [&](int k) {
            if (!step(descents[k])) {
                left[k] = 0;
                return;
            }
            const char* next = reinterpret_cast<const char*>(&nodes_[descents[k].node]);
            for (size_t line = 0; line < sizeof(Node); line += 64) __builtin_prefetch(next + line);
        });
}

void LightTree::sample(const Vec3x8& reference, const Double8& u, const Mask8& wanted,
                       Picks& picks) const {
    if (only_ >= 0 || nodes_.empty()) {
        picks.light.fill(only_);
        picks.probability.fill(1);
        return;
    }
    std::array<Descent, lane_count> descents;
    for_each_lane(wanted, [&](int k) { descents[k] = begin(reference[k], u[k]); });
    go_down(descents, wanted);
    for_each_lane(wanted, [&](int k) {
        picks.light[k] = ~descents[k].node;
        picks.probability[k] = probability_of(descents[k]);
    });
}

std::array<double, lane_count> LightTree::probabilities(const std::array<int, lane_count>& lights,
                                                        const Vec3x8& reference,
                                                        const Mask8& wanted) const {
    std::array<double, lane_count> p{};
    Mask8 in_tree{};
    std::array<Descent, lane_count> descents;
    for_each_lane(wanted, [&](int k) {
        if (turns_[lights[k]] == 0) return;
        p[k] = 1;
        if (only_ >= 0) return;
        descents[k] = along(lights[k], reference[k]);
        in_tree[k] = -1;
    });
    go_down(descents, in_tree);
    for_each_lane(in_tree, [&](int k) { p[k] = probability_of(descents[k]); });
    return p;
}

double LightTree::probability(int light, const vec3& reference) const {
    if (turns_[light] == 0) return 0;
    if (only_ >= 0) return 1;
    Descent d = along(light, reference);
    while (step(d)) {
    }
    return probability_of(d);
}

}  // namespace midway
