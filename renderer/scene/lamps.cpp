#include "scene/lamps.h"

#include <array>
#include <optional>

namespace midway {
namespace {

// Of the diagonal: how far a fourth corner may lie from where a parallelogram has it. Halves that
// differ by as little are worth the same number of points; each one's density is its own.
constexpr float skew = 1e-3f;

struct Apexes {
    int first = 0, second = 0;
};
// The vertices that two triangles do not share, where they form a parallelogram with one front.
std::optional<Apexes> apexes_of_parallelogram(const FlatTriangle& a, const FlatTriangle& b) {
    const std::array<vec3, 3> p{a.v0, a.v1, a.v2}, q{b.v0, b.v1, b.v2};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const vec3 &from = p[(i + 1) % 3], &to = p[(i + 2) % 3];
            if (from != q[(j + 2) % 3] || to != q[(j + 1) % 3]) continue;
            const vec3 off = p[i] + q[j] - from - to;
            if (length_squared(off) <= sqr(skew) * length_squared(from - to)) return Apexes{i, j};
        }
    return {};
}

// Counted from vertex `first`.
void turn(LampTriangle& t, int first) {
    FlatTriangle& f = t.shape;
    const std::array<vec3, 3> v{f.v0, f.v1, f.v2};
    t.turned = static_cast<std::uint8_t>(first);
    f.v0 = v[first];
    f.v1 = v[(first + 1) % 3];
    f.v2 = v[(first + 2) % 3];
    f.extent = max_component(glm::max(glm::abs(f.v1 - f.v0), glm::abs(f.v2 - f.v0)));
}

}  // namespace

LampTriangles make_lamps(const Geometry& g, const std::vector<Light>& lights) {
    std::vector<LampTriangle> lamps;
    lamps.reserve(lights.size());
    for (const Light& l : lights) {
        const Object& o = g.objects[l.object];
        lamps.push_back({flat_triangle(o, l.triangle), o.material, 4 * l.area});
    }
    for (size_t i = 0; i + 1 < lamps.size(); ++i) {
        if (lights[i].object != lights[i + 1].object) continue;
        const auto apexes = apexes_of_parallelogram(lamps[i].shape, lamps[i + 1].shape);
        if (!apexes) continue;
        turn(lamps[i], apexes->first);
        turn(lamps[i + 1], apexes->second);
        lamps[i].partner = 1;
        lamps[i + 1].partner = -1;
        // Both are drawn in the same way wherever next event asks.
        lamps[i + 1].near_squared = lamps[i].near_squared;
        ++i;
    }
    return std::make_shared<const std::vector<LampTriangle>>(std::move(lamps));
}

TriangleHit hit_on_lamp(const LampTriangle& t, const Light& l, const vec2& b) {
    std::array<float, 3> weights{};
    weights[t.turned] = 1 - b.x - b.y;
    weights[(t.turned + 1) % 3] = b.x;
    weights[(t.turned + 2) % 3] = b.y;
    return {l.object, l.triangle, weights[1], weights[2]};
}

}  // namespace midway
