#include "scene/reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "math/frame.h"

namespace midway {
namespace {

// Tests of a block or a vertex: a tenth of a second.
constexpr std::int64_t most_steps = 20'000'000;
constexpr size_t block_size = 64;
// How much of its size the place of a triangle is uncertain by, in float: what lies in front of its
// plane by less lies in the plane. A lamp's own rays begin three times as high (triangle_point).
constexpr double plane_margin = 4 * 0x1p-24;
// Of the cosine of a cone's angle, some steps of a float.
constexpr double cosine_margin = 16 * 0x1p-24;

// Successive triangles of an object with their bounds.
struct Block {
    const Object* object = nullptr;
    size_t begin = 0, end = 0;
    vec3 lower{0}, upper{0};
};

std::vector<Block> make_blocks(const Geometry& g) {
    std::vector<Block> blocks;
    for (const Object& o : g.objects)
        for (size_t begin = 0; begin < o.triangles.size(); begin += block_size) {
            Block b{&o, begin, std::min(begin + block_size, o.triangles.size())};
            b.lower = b.upper = o.positions[o.triangles[begin].x];
            for (size_t t = b.begin; t < b.end; ++t)
                for (int k = 0; k < 3; ++k) {
                    b.lower = glm::min(b.lower, o.positions[o.triangles[t][k]]);
                    b.upper = glm::max(b.upper, o.positions[o.triangles[t][k]]);
                }
            blocks.push_back(b);
        }
    return blocks;
}

std::array<vec3, 8> corners(const Block& b) {
    std::array<vec3, 8> c;
    for (size_t i = 0; i < c.size(); ++i)
        c[i] = {i & 1 ? b.upper.x : b.lower.x, i & 2 ? b.upper.y : b.lower.y,
                i & 4 ? b.upper.z : b.lower.z};
    return c;
}

struct Plane {
    dvec3 normal{0}, point{0};
    double margin = 0;
    bool in_front(const dvec3& p) const { return glm::dot(normal, p - point) > margin; }
};

// Planes through the apex with the whole cone on one side: what lies on the other is not lit.
struct Cone {
    dvec3 apex{0};
    std::array<dvec3, 17> outward;  // normals

    template <class Points>
    bool passes_by(const Points& convex) const {
        for (const dvec3& n : outward) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const vec3& p : convex) nearest = std::min(nearest, glm::dot(n, dvec3(p) - apex));
            // A scene's radius is one.
            if (nearest > plane_margin) return true;
        }
        return false;
    }
};

// Empty where nothing can be told: the cone is half of space.
std::optional<Cone> make_cone(const Light& l) {
    const double angle = std::acos(std::clamp(double(l.cos_outer) - cosine_margin, -1.0, 1.0));
    if (!(angle < 1.57)) return {};
    const Frame f = frame_from_normal(l.direction);
    const dvec3 axis(l.direction);
    Cone cone{dvec3(l.position), {}};
    cone.outward.back() = -axis;
    for (size_t i = 0; i + 1 < cone.outward.size(); ++i) {
        const double azimuth = 0.125 * std::numbers::pi * double(i);
        const dvec3 aside = dvec3(f.s) * std::cos(azimuth) + dvec3(f.t) * std::sin(azimuth);
        cone.outward[i] = aside * std::cos(angle) - axis * std::sin(angle);
    }
    return cone;
}

struct Search {
    std::vector<Block> blocks;
    std::int64_t steps = 0;
    // The vertex that the last lamp was found to shine on: mostly the next one does too.
    dvec3 seen{0};

    bool given_up() const { return steps > most_steps; }

    bool any_in_front(const Plane& plane, const Block& b) {
        const dvec3 far(plane.normal.x > 0 ? b.upper.x : b.lower.x,
                        plane.normal.y > 0 ? b.upper.y : b.lower.y,
                        plane.normal.z > 0 ? b.upper.z : b.lower.z);
        ++steps;
        if (!plane.in_front(far)) return false;
        for (size_t t = b.begin; t < b.end; ++t)
            for (int k = 0; k < 3; ++k) {
                const dvec3 p(b.object->positions[b.object->triangles[t][k]]);
                ++steps;
                if (!plane.in_front(p)) continue;
                seen = p;
                return true;
            }
        return false;
    }

    bool triangle_reaches(const Object& o, const Light& l) {
        const uvec3& t = o.triangles[static_cast<size_t>(l.triangle)];
        const dvec3 a(o.positions[t.x]), b(o.positions[t.y]), c(o.positions[t.z]);
        const dvec3 n = glm::cross(b - a, c - a);
        const double length = glm::length(n);
        if (l.two_sided || !(length > 0)) return true;
        const dvec3 extent = glm::max(glm::abs(b - a), glm::abs(c - a));
        const dvec3 size = glm::abs(a) + extent;
        const Plane plane{n / length, a, plane_margin * std::max({size.x, size.y, size.z})};
        if (plane.in_front(seen)) return true;
        for (const Block& block : blocks)
            if (given_up() || any_in_front(plane, block)) return true;
        return false;
    }

    bool cone_reaches(const Light& l) {
        const std::optional<Cone> cone = make_cone(l);
        if (!cone) return true;
        for (const Block& b : blocks) {
            ++steps;
            if (given_up()) return true;
            if (cone->passes_by(corners(b))) continue;
            for (size_t t = b.begin; t < b.end; ++t) {
                const Object& o = *b.object;
                const uvec3& v = o.triangles[t];
                ++steps;
                if (!cone->passes_by(
                        std::array{o.positions[v.x], o.positions[v.y], o.positions[v.z]}))
                    return true;
            }
        }
        return false;
    }
};

}  // namespace

void find_reach(Scene& s) {
    if (s.geometry->triangle_count == 0) return;
    Search search{make_blocks(*s.geometry)};
    const Block& first = search.blocks.front();
    search.seen = dvec3(first.object->positions[first.object->triangles[first.begin].x]);
    for (Light& l : s.lights) {
        if (!(l.power > 0)) continue;
        if (l.kind == LightKind::area)
            l.reaches = search.triangle_reaches(s.geometry->objects[l.object], l);
        else if (l.kind == LightKind::spot)
            l.reaches = search.cone_reaches(l);
    }
}

}  // namespace midway
