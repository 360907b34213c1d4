#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "scenes.h"

namespace midway::assets {
namespace {

struct Face {
    std::array<dvec3, 3> p;
    dvec3 normal;
    int object = 0;
};

// Faces with the same key lie in one plane and look the same way.
using Plane = std::array<long, 4>;
Plane plane_of(const Face& f) {
    const dvec3 n = f.normal * 1e4;
    return {std::lround(n.x), std::lround(n.y), std::lround(n.z),
            std::lround(glm::dot(f.normal, f.p[0]) * 1e5)};
}

// Whether a line along one of `a`'s edges parts two triangles of one plane; touching is parted.
bool parted(const Face& a, const Face& b) {
    for (int k = 0; k < 3; ++k) {
        const dvec3 outwards = glm::cross(a.p[(k + 1) % 3] - a.p[k], a.normal);
        const auto beyond = [&](const dvec3& q) {
            return glm::dot(q - a.p[k], outwards) > -1e-6 * glm::length(outwards);
        };
        if (beyond(b.p[0]) && beyond(b.p[1]) && beyond(b.p[2])) return true;
    }
    return false;
}

}  // namespace

void check_scene(const Scene& scene) {
    std::map<Plane, std::vector<Face>> planes;
    for (int i = 0; i < int(scene.objects.size()); ++i) {
        const Object& o = scene.objects[i];
        const Mesh& mesh = scene.geometries[o.geometry].mesh;
        for (const uvec3& t : mesh.triangles) {
            Face f{.p = {}, .normal = {}, .object = i};
            for (int k = 0; k < 3; ++k)
                f.p[k] = dvec3(o.to_world * glm::dvec4(mesh.positions[t[k]], 1));
            f.normal = glm::normalize(glm::cross(f.p[1] - f.p[0], f.p[2] - f.p[0]));
            std::vector<Face>& others = planes[plane_of(f)];
            for (const Face& other : others)
                if (scene.objects[other.object].material != o.material && !parted(f, other) &&
                    !parted(other, f))
                    throw std::runtime_error(
                        "faces of " + o.name + " and " + scene.objects[other.object].name +
                        " coincide (scene " + scene.name + "); move one of them a millimetre");
            others.push_back(f);
        }
    }
}

}  // namespace midway::assets
