#include "mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

namespace midway::assets {

dmat4 translation(const dvec3& offset) { return glm::translate(dmat4(1.0), offset); }

dmat4 rotation(const dvec3& axis, double degrees) {
    return glm::rotate(dmat4(1.0), degrees * pi / 180, glm::normalize(axis));
}

dmat4 scaling(const dvec3& factors) { return glm::scale(dmat4(1.0), factors); }

dmat4 looking_at(const dvec3& eye, const dvec3& target, const dvec3& up) {
    return glm::inverse(glm::lookAt(eye, target, up));
}

void append(Mesh& mesh, const Mesh& other) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    for (const uvec3& t : other.triangles) mesh.triangles.push_back(t + base);
}

Mesh transformed(const Mesh& mesh, const dmat4& to_world) {
    Mesh result = mesh;
    const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(glm::dmat3(to_world)));
    for (dvec3& p : result.positions) p = dvec3(to_world * glm::dvec4(p, 1));
    for (dvec3& n : result.normals) n = glm::normalize(normal_matrix * n);
    return result;
}

Mesh turned_inside_out(const Mesh& mesh) {
    Mesh result = mesh;
    for (dvec3& n : result.normals) n = -n;
    for (uvec3& t : result.triangles) std::swap(t.y, t.z);
    return result;
}

Mesh quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    const dvec3 normal = glm::normalize(glm::cross(c - a, d - b));
    return {{a, b, c, d}, {normal, normal, normal, normal}, {{0, 1, 2}, {0, 2, 3}}};
}

Mesh box(const dvec3& l, const dvec3& h) {
    Mesh mesh;
    append(mesh, quad({l.x, l.y, h.z}, {h.x, l.y, h.z}, {h.x, h.y, h.z}, {l.x, h.y, h.z}));
    append(mesh, quad({h.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, h.y, l.z}, {h.x, h.y, l.z}));
    append(mesh, quad({h.x, l.y, h.z}, {h.x, l.y, l.z}, {h.x, h.y, l.z}, {h.x, h.y, h.z}));
    append(mesh, quad({l.x, l.y, l.z}, {l.x, l.y, h.z}, {l.x, h.y, h.z}, {l.x, h.y, l.z}));
    append(mesh, quad({l.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, h.y, l.z}, {l.x, h.y, l.z}));
    append(mesh, quad({l.x, l.y, l.z}, {h.x, l.y, l.z}, {h.x, l.y, h.z}, {l.x, l.y, h.z}));
    return mesh;
}

namespace {

// Joins vertices that agree in position and normal, so that a surface made of patches is closed.
Mesh welded(const Mesh& mesh) {
    const auto key = [](const dvec3& p, const dvec3& n) {
        std::array<long long, 6> k{};
        for (int i = 0; i < 3; ++i) {
            k[i] = std::llround(p[i] * 1e8);
            k[3 + i] = std::llround(n[i] * 1e5);
        }
        return k;
    };
    Mesh result;
    std::map<std::array<long long, 6>, std::uint32_t> known;
    std::vector<std::uint32_t> renamed(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const auto [entry, is_new] = known.try_emplace(key(mesh.positions[i], mesh.normals[i]),
                                                       std::uint32_t(result.positions.size()));
        renamed[i] = entry->second;
        if (!is_new) continue;
        result.positions.push_back(mesh.positions[i]);
        result.normals.push_back(mesh.normals[i]);
    }
    for (const uvec3& t : mesh.triangles) {
        const uvec3 r(renamed[t.x], renamed[t.y], renamed[t.z]);
        if (r.x != r.y && r.y != r.z && r.z != r.x) result.triangles.push_back(r);
    }
    return result;
}

}  // namespace

Mesh rounded_box(const dvec3& half_extent, double radius, int segments) {
    Mesh mesh;
    const dvec3 core = half_extent - radius;
    const int side = 2 * segments + 2;  // grid points across a face: two rounded ends, one flat
    const auto angle = [&](int i) {
        const int step = i <= segments ? i - segments : i - segments - 1;
        return step * (pi / 4) / segments;
    };
    for (int face = 0; face < 6; ++face) {
        const int w = face / 2, u = (w + 1) % 3, v = (w + 2) % 3;
        const double sign = face % 2 == 0 ? 1 : -1;
        Mesh patch;
        for (int j = 0; j < side; ++j) {
            for (int i = 0; i < side; ++i) {
                dvec3 n, p;
                n[u] = std::tan(angle(i));
                n[v] = std::tan(angle(j));
                n[w] = sign;
                n = glm::normalize(n);
                p[u] = i <= segments ? -core[u] : core[u];
                p[v] = j <= segments ? -core[v] : core[v];
                p[w] = sign * core[w];
                patch.positions.push_back(p + radius * n);
                patch.normals.push_back(n);
                if (i == 0 || j == 0) continue;
                const std::uint32_t d = j * side + i, c = d - 1, b = d - side, a = b - 1;
                patch.triangles.push_back({a, b, d});
                patch.triangles.push_back({a, d, c});
            }
        }
        if (sign < 0)
            for (uvec3& t : patch.triangles) std::swap(t.y, t.z);
        append(mesh, patch);
    }
    return welded(mesh);
}

Mesh icosphere(double radius, int subdivisions) {
    const double g = (1 + std::sqrt(5.0)) / 2;
    Mesh mesh;
    mesh.normals = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (dvec3& n : mesh.normals) n = glm::normalize(n);
    for (int level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, is_new] =
                middles.try_emplace(std::minmax(a, b), std::uint32_t(mesh.normals.size()));
            if (is_new) mesh.normals.push_back(glm::normalize(mesh.normals[a] + mesh.normals[b]));
            return entry->second;
        };
        std::vector<uvec3> finer;
        for (const uvec3& t : mesh.triangles) {
            const std::uint32_t a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
        }
        mesh.triangles = std::move(finer);
    }
    for (const dvec3& n : mesh.normals) mesh.positions.push_back(n * radius);
    return mesh;
}

namespace {

struct ProfilePoint {
    dvec2 point, normal;
    bool joined_to_next = true;
};

// One entry per distinct (point, normal) of the profile; sharp points give two entries, not joined.
std::vector<ProfilePoint> profile_points(const std::vector<dvec2>& profile, bool closed) {
    const int count = static_cast<int>(profile.size());
    const auto segment_normal = [&](int i) {  // of the segment from i to i + 1; zero where none
        if (!closed && (i < 0 || i + 1 >= count)) return dvec2(0);
        const dvec2 d = profile[(i + 1 + count) % count] - profile[(i + count) % count];
        const double length = glm::length(d);
        return length > 0 ? dvec2(d.y, -d.x) / length : dvec2(0);
    };
    std::vector<ProfilePoint> points;
    for (int i = 0; i < count; ++i) {
        const bool sharp_next = i + 1 < count && profile[i] == profile[i + 1];
        dvec2 normal = segment_normal(i - 1) + segment_normal(i);
        if (profile[i].x == 0) normal = {0, normal.y > 0 ? 1.0 : -1.0};
        points.push_back({profile[i], glm::normalize(normal), !sharp_next});
    }
    if (!closed) points.back().joined_to_next = false;
    return points;
}

}  // namespace

Mesh lathe(const std::vector<dvec2>& profile, int segments, bool closed) {
    const std::vector<ProfilePoint> points = profile_points(profile, closed);
    Mesh mesh;
    std::vector<std::uint32_t> first(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        first[i] = static_cast<std::uint32_t>(mesh.positions.size());
        const int copies = points[i].point.x == 0 ? 1 : segments;
        for (int k = 0; k < copies; ++k) {
            const double angle = 2 * pi * k / segments;
            const dvec3 out(std::cos(angle), 0, -std::sin(angle));
            mesh.positions.push_back(out * points[i].point.x + dvec3(0, points[i].point.y, 0));
            mesh.normals.push_back(out * points[i].normal.x + dvec3(0, points[i].normal.y, 0));
        }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!points[i].joined_to_next) continue;
        const std::size_t j = (i + 1) % points.size();
        const bool pole_i = points[i].point.x == 0, pole_j = points[j].point.x == 0;
        for (int k = 0; k < segments; ++k) {
            const std::uint32_t next = (k + 1) % segments;
            const std::uint32_t a = first[i] + (pole_i ? 0 : k), b = first[i] + (pole_i ? 0 : next);
            const std::uint32_t c = first[j] + (pole_j ? 0 : next), d = first[j] + (pole_j ? 0 : k);
            if (!pole_i) mesh.triangles.push_back({a, b, c});
            if (!pole_j) mesh.triangles.push_back({a, c, d});
        }
    }
    return mesh;
}

std::vector<dvec2> block_profile(double radius, double height, double bevel, int bevel_segments) {
    std::vector<dvec2> profile = {{0, 0}};
    const auto corner = [&](double y, double from_degrees) {
        const dvec2 centre(radius - bevel, y);
        for (int i = 0; i <= bevel_segments; ++i) {
            const double a = (from_degrees + 90.0 * i / bevel_segments) * pi / 180;
            const dvec2 p = centre + bevel * dvec2(std::cos(a), std::sin(a));
            profile.push_back(p);
            if (i == 0 || i == bevel_segments) profile.push_back(p);
        }
    };
    corner(bevel, -90);
    corner(height - bevel, 0);
    profile.push_back({0, height});
    return profile;
}

Mesh cylinder(double radius, double height, double bevel, int segments) {
    return lathe(block_profile(radius, height, bevel, 4), segments);
}

Mesh torus(double radius, double tube_radius, int segments, int tube_segments) {
    std::vector<dvec2> profile;
    for (int i = 0; i < tube_segments; ++i) {
        const double a = 2 * pi * i / tube_segments;
        profile.push_back({radius + tube_radius * std::cos(a), tube_radius * std::sin(a)});
    }
    return lathe(profile, segments, true);
}

Mesh tube(const std::vector<dvec3>& curve, double radius, int segments) {
    Mesh mesh;
    const int count = static_cast<int>(curve.size());
    dvec3 side(0);
    for (int i = 0; i < count; ++i) {
        const dvec3 along =
            glm::normalize(curve[std::min(i + 1, count - 1)] - curve[std::max(i - 1, 0)]);
        if (i == 0) side = std::abs(along.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
        side = glm::normalize(side - along * glm::dot(side, along));  // carried along untwisted
        const dvec3 other = glm::cross(along, side);
        for (int k = 0; k < segments; ++k) {
            const double a = 2 * pi * k / segments;
            const dvec3 n = side * std::cos(a) + other * std::sin(a);
            mesh.positions.push_back(curve[i] + n * radius);
            mesh.normals.push_back(n);
            if (i == 0) continue;
            const std::uint32_t low = (i - 1) * segments, high = i * segments;
            const std::uint32_t next = (k + 1) % segments;
            mesh.triangles.push_back({low + k, low + next, high + next});
            mesh.triangles.push_back({low + k, high + next, high + k});
        }
    }
    for (const bool end : {false, true}) {
        const int ring = end ? count - 1 : 0;
        const dvec3 outward =
            glm::normalize(end ? curve[count - 1] - curve[count - 2] : curve[0] - curve[1]);
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k < segments; ++k) {
            mesh.positions.push_back(mesh.positions[ring * segments + k]);
            mesh.normals.push_back(outward);
            if (k < 2) continue;
            const std::uint32_t a = base, b = base + k - 1, c = base + k;
            mesh.triangles.push_back(end ? uvec3(a, b, c) : uvec3(a, c, b));
        }
    }
    return mesh;
}

Mesh checker_half(const dvec2& low, const dvec2& high, int columns, int rows, bool odd) {
    Mesh mesh;
    const dvec2 step = (high - low) / dvec2(columns, rows);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            if (((i + j) % 2 == 1) != odd) continue;
            const dvec2 a = low + step * dvec2(i, j), b = a + step;
            append(mesh, quad({a.x, 0, b.y}, {b.x, 0, b.y}, {b.x, 0, a.y}, {a.x, 0, a.y}));
        }
    return mesh;
}

double Random::next() {
    state += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1p-53;
}

double Random::between(double low, double high) { return low + (high - low) * next(); }
int Random::below(int count) { return static_cast<int>(next() * count); }

}  // namespace midway::assets
