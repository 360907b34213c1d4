#include "scene/duplicates.h"

#include <tuple>

#include "math/hash.h"

namespace midway {
namespace {

struct Place {
    std::uint64_t hash = 0;
    std::uint32_t object = 0, triangle = 0;
};

// The corners, beginning with the smallest; adding zero makes one of the two zeros of float.
using Corners = std::array<float, 9>;
Corners corners(const Object& o, const uvec3& t) {
    const auto less = [](const vec3& a, const vec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    const vec3 p[3] = {o.positions[t.x] + 0.0f, o.positions[t.y] + 0.0f, o.positions[t.z] + 0.0f};
    int first = 0;
    for (int k = 1; k < 3; ++k)
        if (less(p[k], p[first])) first = k;
    Corners c;
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) c[3 * k + i] = p[(first + k) % 3][i];
    return c;
}

// In order of hash, then of object and triangle: copies lie side by side, the first one first.
std::vector<Place> sorted_places(const std::vector<Object>& objects) {
    std::vector<Place> places;
    for (size_t k = 0; k < objects.size(); ++k) {
        const Object& o = objects[k];
        if (o.may_be_transparent) continue;
        for (size_t t = 0; t < o.triangles.size(); ++t) {
            const Corners c = corners(o, o.triangles[t]);
            places.push_back({hash_bytes(std::uint64_t(o.material), c.data(), sizeof c),
                              static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(t)});
        }
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
        return std::tie(a.hash, a.object, a.triangle) < std::tie(b.hash, b.object, b.triangle);
    });
    return places;
}

}  // namespace

size_t remove_duplicate_triangles(std::vector<Object>& objects) {
    const std::vector<Place> places = sorted_places(objects);
    std::vector<std::vector<bool>> copies(objects.size());
    const Place* kept = nullptr;
    size_t removed = 0;
    for (const Place& p : places) {
        const Object& o = objects[p.object];
        const bool copy =
            kept && kept->hash == p.hash && objects[kept->object].material == o.material &&
            corners(objects[kept->object], objects[kept->object].triangles[kept->triangle]) ==
                corners(o, o.triangles[p.triangle]);
        if (!copy) {
            kept = &p;
            continue;
        }
        copies[p.object].resize(o.triangles.size());
        copies[p.object][p.triangle] = true;
        ++removed;
    }
    for (size_t k = 0; k < objects.size(); ++k) {
        if (copies[k].empty()) continue;
        std::vector<uvec3> left;
        for (size_t t = 0; t < copies[k].size(); ++t)
            if (!copies[k][t]) left.push_back(objects[k].triangles[t]);
        objects[k].triangles = std::move(left);
    }
    return removed;
}

}  // namespace midway
