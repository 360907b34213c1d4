#include "io/tangents.h"

#include <array>
#include <cstring>
#include <unordered_map>

namespace midway {
namespace {

// What corners must have in common to share a tangent: position, normal, texture coordinate, side.
using CornerKey = std::array<std::uint32_t, 9>;

struct CornerHash {
    std::size_t operator()(const CornerKey& key) const {
        std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a over words (Fowler, Noll, Vo)
        for (const std::uint32_t word : key) hash = (hash ^ word) * 0x100000001b3ull;
        return hash ^ (hash >> 32);
    }
};

using TangentSums = std::unordered_map<CornerKey, dvec3, CornerHash>;

struct FaceTangent {
    dvec3 direction{0};
    dvec3 normal{0};  // geometric
    int side = 0;     // tangent.w; 0 where the texture coordinates span no area
};

dvec3 normalized_or_zero(const dvec3& v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : dvec3(0);
}

dvec3 any_perpendicular(const dvec3& n) {
    const dvec3 axis = std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 tangent = glm::cross(glm::cross(n, axis), n);
    return glm::dot(tangent, tangent) > 0 ? glm::normalize(tangent) : dvec3(1, 0, 0);
}

FaceTangent face_tangent(const Mesh& mesh, const std::vector<vec2>& uv, const uvec3& triangle) {
    const dvec3 p = mesh.positions[triangle.x];
    const dvec3 e1 = dvec3(mesh.positions[triangle.y]) - p;
    const dvec3 e2 = dvec3(mesh.positions[triangle.z]) - p;
    const dvec2 t1 = dvec2(uv[triangle.y]) - dvec2(uv[triangle.x]);
    const dvec2 t2 = dvec2(uv[triangle.z]) - dvec2(uv[triangle.x]);
    const double area = t1.x * t2.y - t1.y * t2.x;
    FaceTangent out;
    out.normal = normalized_or_zero(glm::cross(e1, e2));
    if (area == 0 || !std::isfinite(area)) return out;
    // With v pointing down, positive area is a mirrored image.
    out.side = area > 0 ? -1 : 1;
    out.direction = normalized_or_zero((t2.y * e1 - t1.y * e2) * (area > 0 ? 1.0 : -1.0));
    return out;
}

std::uint32_t bits(float value) {
    std::uint32_t word = 0;
    const float positive_zero = value == 0 ? 0.0f : value;
    std::memcpy(&word, &positive_zero, sizeof word);
    return word;
}

CornerKey corner_key(const Mesh& mesh, const std::vector<vec2>& uv, std::uint32_t v, int side) {
    const vec3 p = mesh.positions[v];
    const vec3 n = mesh.normals.empty() ? vec3(static_cast<float>(v), 0, 0) : mesh.normals[v];
    return {bits(p.x),     bits(p.y),     bits(p.z),
            bits(n.x),     bits(n.y),     bits(n.z),
            bits(uv[v].x), bits(uv[v].y), static_cast<std::uint32_t>(side)};
}

dvec3 project(const dvec3& v, const dvec3& normal) {
    return normalized_or_zero(v - normal * glm::dot(normal, v));
}

// The angle at corner `c` between its edges, seen along the normal.
double corner_angle(const Mesh& mesh, const uvec3& triangle, int c, const dvec3& normal) {
    const dvec3 p = mesh.positions[triangle[c]];
    const dvec3 a = project(dvec3(mesh.positions[triangle[(c + 1) % 3]]) - p, normal);
    const dvec3 b = project(dvec3(mesh.positions[triangle[(c + 2) % 3]]) - p, normal);
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

template <typename T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& from) {
    if (values.empty()) return;
    std::vector<T> out(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) out[i] = values[from[i]];
    values = std::move(out);
}

void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& from) {
    gather(mesh.positions, from);
    gather(mesh.normals, from);
    gather(mesh.colors, from);
    for (std::vector<vec2>& set : mesh.texcoords) gather(set, from);
}

void separate_corners(Mesh& mesh) {
    std::vector<std::uint32_t> from;
    from.reserve(mesh.triangles.size() * 3);
    for (uvec3& triangle : mesh.triangles) {
        for (int c = 0; c < 3; ++c) {
            from.push_back(triangle[c]);
            triangle[c] = static_cast<std::uint32_t>(from.size() - 1);
        }
    }
    gather_vertices(mesh, from);
}

// Gives vertices that triangles of both sides share a second copy; returns the side of each vertex.
std::vector<int> separate_sides(Mesh& mesh, const std::vector<FaceTangent>& faces) {
    std::vector<int> sides(mesh.positions.size(), 0);
    std::vector<std::uint32_t> from(mesh.positions.size());
    for (std::size_t v = 0; v < from.size(); ++v) from[v] = static_cast<std::uint32_t>(v);
    std::unordered_map<std::uint32_t, std::uint32_t> copies;
    for (std::size_t t = 0; t < faces.size(); ++t) {
        if (faces[t].side == 0) continue;
        for (int c = 0; c < 3; ++c) {
            std::uint32_t& v = mesh.triangles[t][c];
            if (sides[v] == 0) sides[v] = faces[t].side;
            if (sides[v] == faces[t].side) continue;
            const auto [copy, added] =
                copies.try_emplace(v, static_cast<std::uint32_t>(from.size()));
            if (added) {
                from.push_back(v);
                sides.push_back(faces[t].side);
            }
            v = copy->second;
        }
    }
    gather_vertices(mesh, from);
    return sides;
}

}  // namespace

void generate_tangents(Mesh& mesh, int texcoord) {
    mesh.tangents.clear();
    if (mesh.normals.empty()) separate_corners(mesh);
    std::vector<FaceTangent> faces;
    faces.reserve(mesh.triangles.size());
    for (const uvec3& triangle : mesh.triangles) {
        faces.push_back(face_tangent(mesh, mesh.texcoords[texcoord], triangle));
    }
    const std::vector<int> sides = separate_sides(mesh, faces);
    const std::vector<vec2>& uv = mesh.texcoords[texcoord];
    TangentSums sums;
    std::vector<dvec3> normals(mesh.positions.size(), dvec3(0, 0, 1));
    for (std::size_t t = 0; t < faces.size(); ++t) {
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t v = mesh.triangles[t][c];
            normals[v] = mesh.normals.empty() ? faces[t].normal : dvec3(mesh.normals[v]);
            if (faces[t].side == 0) continue;
            const double angle = corner_angle(mesh, mesh.triangles[t], c, normals[v]);
            sums[corner_key(mesh, uv, v, sides[v])] +=
                project(faces[t].direction, normals[v]) * angle;
        }
    }
    mesh.tangents.resize(mesh.positions.size());
    for (std::uint32_t v = 0; v < mesh.tangents.size(); ++v) {
        const auto sum = sums.find(corner_key(mesh, uv, v, sides[v]));
        dvec3 tangent = sum == sums.end() ? dvec3(0) : normalized_or_zero(sum->second);
        if (tangent == dvec3(0)) tangent = any_perpendicular(normals[v]);
        mesh.tangents[v] = vec4(vec3(tangent), sides[v] < 0 ? -1.0f : 1.0f);
    }
}

}  // namespace midway
