// What a renderer cannot use is taken out of a mesh here, in one place, so that nothing later has
// to look for it.
#include <algorithm>
#include <cmath>

#include "io/gltf_mesh.h"

namespace midway::gltf {
namespace {

// Beyond it squares of lengths overflow in float.
constexpr float largest_coordinate = 1e18f;

bool usable(const vec3& p) {
    return is_finite(p) && max_component(glm::abs(p)) <= largest_coordinate;
}

void report(Document& document, const std::string& name, std::size_t count, const char* what) {
    if (count > 0) warn(document, name + ": " + std::to_string(count) + " " + what);
}

void drop_triangles(Document& document, const std::string& name, Mesh& mesh) {
    std::size_t infinite = 0, flat = 0;
    const auto unusable = [&](const uvec3& t) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        if (!usable(a) || !usable(b) || !usable(c)) {
            ++infinite;
            return true;
        }
        const dvec3 area = glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a));
        if (area != dvec3(0)) return false;
        ++flat;
        return true;
    };
    mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), unusable),
                         mesh.triangles.end());
    report(document, name, infinite, "triangles with infinite or undefined corners are left out");
    report(document, name, flat, "triangles without area are left out");
}

// Area-weighted normals of the triangles around each vertex.
std::vector<dvec3> surface_normals(const Mesh& mesh) {
    std::vector<dvec3> normals(mesh.positions.size(), dvec3(0));
    for (const uvec3& t : mesh.triangles) {
        const dvec3 a = mesh.positions[t.x];
        const dvec3 n = glm::cross(dvec3(mesh.positions[t.y]) - a, dvec3(mesh.positions[t.z]) - a);
        for (int c = 0; c < 3; ++c) normals[t[c]] += n;
    }
    return normals;
}

// v at unit length, zero where that does not exist.
vec3 unit_or_zero(const dvec3& v) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? vec3(v / length) : vec3(0);
}

void mend_normals(Document& document, const std::string& name, Mesh& mesh) {
    std::vector<dvec3> surface;
    std::size_t mended = 0;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        vec3 n = unit_or_zero(dvec3(mesh.normals[i]));
        if (n == vec3(0)) {
            if (surface.empty()) surface = surface_normals(mesh);
            n = unit_or_zero(surface[i]);
            if (n == vec3(0)) n = vec3(0, 0, 1);
            ++mended;
        }
        mesh.normals[i] = n;
    }
    report(document, name, mended, "normals without direction are replaced by the surface's");
}

void mend_tangents(Document& document, const std::string& name, Mesh& mesh) {
    for (vec4& tangent : mesh.tangents) {
        const vec3 direction = unit_or_zero(dvec3(tangent.x, tangent.y, tangent.z));
        if (direction == vec3(0) || !std::isfinite(tangent.w)) {
            warn(document, name + " has tangents without direction; computed anew");
            mesh.tangents.clear();
            return;
        }
        tangent = vec4(direction, tangent.w < 0 ? -1.0f : 1.0f);
    }
}

template <typename V>
std::size_t mend_values(std::vector<V>& values, float otherwise) {
    std::size_t mended = 0;
    for (V& value : values) {
        for (int c = 0; c < V::length(); ++c) {
            if (std::isfinite(value[c]) && std::abs(value[c]) <= largest_coordinate) continue;
            value[c] = otherwise;
            ++mended;
        }
    }
    return mended;
}

template <typename T>
void keep(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
    values.resize(kept.size());
    values.shrink_to_fit();
}

void drop_vertices(Mesh& mesh) {
    constexpr std::uint32_t unused = 0xffffffffu;
    std::vector<std::uint32_t> place(mesh.positions.size(), unused);
    for (const uvec3& t : mesh.triangles) {
        for (int c = 0; c < 3; ++c) place[t[c]] = 0;
    }
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < place.size(); ++i) {
        if (place[i] == unused) continue;
        place[i] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(static_cast<std::uint32_t>(i));
    }
    if (kept.size() == place.size()) return;
    keep(mesh.positions, kept);
    keep(mesh.normals, kept);
    keep(mesh.tangents, kept);
    keep(mesh.colors, kept);
    for (std::vector<vec2>& set : mesh.texcoords) keep(set, kept);
    for (uvec3& t : mesh.triangles) t = uvec3(place[t.x], place[t.y], place[t.z]);
}

}  // namespace

void clean_mesh(Document& document, const std::string& name, Mesh& mesh) {
    drop_triangles(document, name, mesh);
    drop_vertices(mesh);
    mend_normals(document, name, mesh);
    mend_tangents(document, name, mesh);
    std::size_t mended = mend_values(mesh.colors, 1.0f);
    for (std::vector<vec2>& set : mesh.texcoords) mended += mend_values(set, 0.0f);
    report(document, name, mended, "undefined colours or texture coordinates are replaced");
}

}  // namespace midway::gltf
