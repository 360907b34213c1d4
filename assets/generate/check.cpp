#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "mesh.h"

namespace midway::assets {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& what) {
    throw std::runtime_error(what + " (mesh " + name + "); correct the generator");
}

// Vertices that share a position count as one here: a sharp edge does not open a surface.
std::vector<std::uint32_t> names_by_position(const Mesh& mesh) {
    std::map<std::array<float, 3>, std::uint32_t> known;
    std::vector<std::uint32_t> names;
    for (const dvec3& p : mesh.positions) {
        const std::array<float, 3> key = {float(p.x), float(p.y), float(p.z)};
        names.push_back(known.try_emplace(key, std::uint32_t(known.size())).first->second);
    }
    return names;
}

void check_triangle(const Mesh& mesh, const uvec3& t, const std::string& name) {
    std::array<dvec3, 3> p;
    for (int k = 0; k < 3; ++k) {
        if (t[k] >= mesh.positions.size()) fail(name, "index out of range");
        p[k] = dvec3(glm::vec3(mesh.positions[t[k]]));
    }
    const dvec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double longest =
        std::max({glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])});
    if (!(glm::length(cross) > 1e-5 * longest * longest)) fail(name, "degenerate triangle");
    for (int k = 0; k < 3; ++k)
        if (!(glm::dot(mesh.normals[t[k]], cross) > 0)) fail(name, "normal against the winding");
}

void check_closed(const Mesh& mesh, const std::string& name) {
    const std::vector<std::uint32_t> names = names_by_position(mesh);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;  // -> opposite vertex
    std::map<std::uint32_t, int> fan_size;
    double volume = 0;
    for (const uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = names[t[k]], b = names[t[(k + 1) % 3]],
                                c = names[t[(k + 2) % 3]];
            if (!edges.try_emplace({a, b}, c).second) fail(name, "edge with three or more faces");
            ++fan_size[a];
        }
        volume +=
            glm::dot(mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z])) / 6;
    }
    for (const auto& [edge, opposite] : edges)
        if (!edges.contains({edge.second, edge.first})) fail(name, "open edge");
    if (!(volume > 0)) fail(name, "closed mesh turned inside out");
    // Walk once around every vertex: one sheet passes all of its triangles.
    std::map<std::uint32_t, bool> walked;
    for (const auto& [edge, opposite] : edges) {
        const std::uint32_t hub = edge.first;
        if (std::exchange(walked[hub], true)) continue;
        int steps = 0;
        std::uint32_t rim = edge.second;
        do {
            rim = edges.at({hub, rim});
            ++steps;
        } while (rim != edge.second);
        if (steps != fan_size[hub]) fail(name, "two sheets meet in a vertex");
    }
}

}  // namespace

void check_mesh(const Mesh& mesh, const std::string& name, bool closed) {
    if (mesh.triangles.empty()) fail(name, "no triangles");
    if (mesh.normals.size() != mesh.positions.size()) fail(name, "normals missing");
    for (const dvec3& n : mesh.normals)
        if (!(std::abs(glm::length(n) - 1) < 1e-6)) fail(name, "normal not of unit length");
    for (const uvec3& t : mesh.triangles) check_triangle(mesh, t, name);
    if (closed) check_closed(mesh, name);
}

}  // namespace midway::assets
