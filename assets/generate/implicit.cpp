#include "implicit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace midway::assets {

double ellipsoid(const dvec3& p, const dvec3& radii) {
    const double k0 = glm::length(p / radii);
    const double k1 = glm::length(p / (radii * radii));
    return k1 > 0 ? k0 * (k0 - 1) / k1 : -std::min({radii.x, radii.y, radii.z});
}

double capsule(const dvec3& p, const dvec3& a, const dvec3& b, double radius_a, double radius_b) {
    const dvec3 along = b - a;
    const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::length(p - a - along * t) - (radius_a + (radius_b - radius_a) * t);
}

double joined(double a, double b, double width) {
    const double h = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - h * h * h * width / 6;
}

double intersected(double a, double b, double width) { return -joined(-a, -b, width); }
double carved(double body, double tool, double width) { return intersected(body, -tool, width); }

namespace {

dvec3 gradient(const Field& field, const dvec3& p) {
    const double h = 1e-5;
    return dvec3(field(p + dvec3(h, 0, 0)) - field(p - dvec3(h, 0, 0)),
                 field(p + dvec3(0, h, 0)) - field(p - dvec3(0, h, 0)),
                 field(p + dvec3(0, 0, h)) - field(p - dvec3(0, 0, h))) /
           (2 * h);
}

dvec3 projected(const Field& field, dvec3 p, double cell) {
    for (int i = 0; i < 6; ++i) {
        const dvec3 g = gradient(field, p);
        const double slope = std::max(glm::dot(g, g), 1e-6);
        const dvec3 step = g * (field(p) / slope);
        const double length = glm::length(step);
        p -= length > cell ? step * (cell / length) : step;
        if (length < 1e-9) break;
    }
    return p;
}

struct Grid {
    glm::ivec3 size{0};  // of corners
    dvec3 low{0};
    double cell = 0;
    std::vector<float> values;

    int index(int x, int y, int z) const { return (z * size.y + y) * size.x + x; }
};

Grid sampled(const Field& field, const PolygoniseSettings& settings) {
    Grid grid;
    grid.low = settings.low;
    grid.cell = settings.cell;
    grid.size = glm::ivec3(glm::ceil((settings.high - settings.low) / settings.cell)) + 1;
    grid.values.reserve(std::size_t(grid.size.x) * grid.size.y * grid.size.z);
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x)
                grid.values.push_back(float(field(grid.low + dvec3(x, y, z) * grid.cell)));
    return grid;
}

// The mean of the crossings on the twelve edges of a cell, or nothing where it has none.
bool cell_point(const Grid& grid, const glm::ivec3& cell, dvec3& point) {
    dvec3 sum(0);
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < 4; ++k) {
            glm::ivec3 a = cell;
            a[(axis + 1) % 3] += k & 1;
            a[(axis + 2) % 3] += k >> 1;
            glm::ivec3 b = a;
            ++b[axis];
            const double va = grid.values[grid.index(a.x, a.y, a.z)];
            const double vb = grid.values[grid.index(b.x, b.y, b.z)];
            if ((va < 0) == (vb < 0)) continue;
            sum += glm::mix(dvec3(a), dvec3(b), va / (va - vb));
            ++count;
        }
    }
    if (count > 0) point = grid.low + sum / double(count) * grid.cell;
    return count > 0;
}

// One vertex in each cell that the surface crosses, one quad for each crossed edge of the grid.
Mesh surface_net(const Grid& grid) {
    Mesh mesh;
    std::vector<int> vertex_of_cell(grid.values.size(), -1);
    for (int z = 0; z + 1 < grid.size.z; ++z)
        for (int y = 0; y + 1 < grid.size.y; ++y)
            for (int x = 0; x + 1 < grid.size.x; ++x) {
                dvec3 point;
                if (!cell_point(grid, {x, y, z}, point)) continue;
                vertex_of_cell[grid.index(x, y, z)] = int(mesh.positions.size());
                mesh.positions.push_back(point);
            }
    for (int z = 1; z + 1 < grid.size.z; ++z)
        for (int y = 1; y + 1 < grid.size.y; ++y)
            for (int x = 1; x + 1 < grid.size.x; ++x)
                for (int axis = 0; axis < 3; ++axis) {
                    const glm::ivec3 a(x, y, z);
                    glm::ivec3 b = a, u(0), v(0);
                    ++b[axis];
                    const bool inside = grid.values[grid.index(x, y, z)] < 0;
                    if (inside == (grid.values[grid.index(b.x, b.y, b.z)] < 0)) continue;
                    u[(axis + 1) % 3] = 1;
                    v[(axis + 2) % 3] = 1;
                    std::array<std::uint32_t, 4> q;
                    const std::array<glm::ivec3, 4> cells = {a - u - v, a - v, a, a - u};
                    for (int k = 0; k < 4; ++k)
                        q[k] = vertex_of_cell[grid.index(cells[k].x, cells[k].y, cells[k].z)];
                    if (!inside) std::swap(q[1], q[3]);
                    // The shorter diagonal makes the better pair of triangles.
                    const auto& p = mesh.positions;
                    if (glm::distance(p[q[0]], p[q[2]]) <= glm::distance(p[q[1]], p[q[3]])) {
                        mesh.triangles.push_back({q[0], q[1], q[2]});
                        mesh.triangles.push_back({q[0], q[2], q[3]});
                    } else {
                        mesh.triangles.push_back({q[1], q[2], q[3]});
                        mesh.triangles.push_back({q[1], q[3], q[0]});
                    }
                }
    return mesh;
}

}  // namespace

Mesh polygonise(const Field& field, const PolygoniseSettings& settings) {
    Mesh mesh = surface_net(sampled(field, settings));
    if (mesh.triangles.empty()) throw std::runtime_error("no surface (polygonise); check bounds");
    for (dvec3& p : mesh.positions) p = projected(field, p, settings.cell);
    for (int round = 0; round < settings.relaxations; ++round) {
        std::vector<dvec3> sum(mesh.positions.size(), dvec3(0));
        std::vector<int> count(mesh.positions.size(), 0);
        for (const uvec3& t : mesh.triangles)
            for (int k = 0; k < 3; ++k) {
                sum[t[k]] += mesh.positions[t[(k + 1) % 3]];
                ++count[t[k]];
            }
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            dvec3& p = mesh.positions[i];
            p = projected(field, glm::mix(p, sum[i] / double(count[i]), 0.5), settings.cell);
        }
    }
    for (const dvec3& p : mesh.positions)
        mesh.normals.push_back(glm::normalize(gradient(field, p)));
    return mesh;
}

}  // namespace midway::assets
