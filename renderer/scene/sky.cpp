#include "scene/sky.h"

#include <glm/gtc/constants.hpp>
#include <stdexcept>

#include "math/warp.h"

namespace midway {
namespace {

vec3 rotate(const Sky& s, const vec3& d, float sign) {
    const float sine = sign * s.sin_rotation;
    return {s.cos_rotation * d.x + sine * d.z, d.y, s.cos_rotation * d.z - sine * d.x};
}

// Map coordinates in texels: the middle column looks along -z, +x lies to its right, row 0 at +y.
dvec2 map_position(const Sky& s, const vec3& d) {
    const double u = 0.5 + std::atan2(double(d.x), -double(d.z)) / (2 * glm::pi<double>());
    const double v = std::acos(std::clamp(double(d.y), -1.0, 1.0)) / glm::pi<double>();
    return {u * s.map->width, v * s.map->height};
}

ivec2 map_cell(const Sky& s, const dvec2& p) {
    return {std::min(static_cast<int>(p.x), s.map->width - 1),
            std::min(static_cast<int>(p.y), s.map->height - 1)};
}

const vec3& texel(const Image& m, int x, int y) {
    return m.at((x % m.width + m.width) % m.width, std::clamp(y, 0, m.height - 1));
}

// Mean over the cell of the bilinear interpolant: weights (1 6 1)/8 each way.
double cell_mean(const Image& m, int x, int y) {
    double sum = 0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const vec3& c = texel(m, x + dx, y + dy);
            sum += (dx ? 1.0 : 6.0) * (dy ? 1.0 : 6.0) * (double(c.x) + c.y + c.z) / 3;
        }
    return sum / 64;
}

// cos(theta) at the upper edge of row y.
double row_cosine(const Sky& s, int y) { return std::cos(glm::pi<double>() * y / s.map->height); }

double cell_solid_angle(const Sky& s, int y) {
    return 2 * glm::pi<double>() / s.map->width * (row_cosine(s, y) - row_cosine(s, y + 1));
}

void check_map(const Image& m, const std::string& source) {
    for (size_t i = 0; i < m.pixels.size(); ++i) {
        const vec3& c = m.pixels[i];
        if (is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0) continue;
        throw std::runtime_error("sky map holds a negative or non-finite value (" + source +
                                 ", pixel " + std::to_string(i % m.width) + "," +
                                 std::to_string(i / m.width) + "); repair the map");
    }
}

std::shared_ptr<const Distribution2D> make_cells(const Sky& s, const std::string& source) {
    check_map(*s.map, source);
    std::vector<double> weights(s.map->pixels.size());
    for (int y = 0; y < s.map->height; ++y) {
        const double solid_angle = cell_solid_angle(s, y);
        for (int x = 0; x < s.map->width; ++x)
            weights[static_cast<size_t>(y) * s.map->width + x] =
                cell_mean(*s.map, x, y) * solid_angle;
    }
    return std::make_shared<const Distribution2D>(
        make_distribution_2d(weights, s.map->width, s.map->height));
}

}  // namespace

Sky make_sky(const SkyDescription& d, const Sky* previous) {
    Sky s;
    s.map = d.map;
    s.scale = d.color * d.strength;
    const double angle = d.rotation_degrees * glm::pi<double>() / 180;
    s.cos_rotation = static_cast<float>(std::cos(angle));
    s.sin_rotation = static_cast<float>(std::sin(angle));
    const float scale_mean = (s.scale.x + s.scale.y + s.scale.z) / 3;
    if (!s.map) {
        s.mean_radiance = scale_mean;
        return s;
    }
    s.cells = previous && previous->map == s.map ? previous->cells : make_cells(s, d.source);
    s.mean_radiance =
        static_cast<float>(s.cells->rows.total / (4 * glm::pi<double>())) * scale_mean;
    return s;
}

SkyDescription default_sky() {
    constexpr int width = 8, height = 32;
    auto map = std::make_shared<Image>(width, height);
    const vec3 zenith(0.55f, 0.65f, 0.8f), horizon(0.85f, 0.85f, 0.83f), ground(0.32f, 0.3f, 0.28f);
    for (int y = 0; y < height; ++y) {
        const float up = std::cos(pi * (y + 0.5f) / height);
        const vec3 c = up > 0 ? glm::mix(horizon, zenith, std::sqrt(up))
                              : glm::mix(horizon, ground, std::min(1.0f, -4 * up));
        for (int x = 0; x < width; ++x) map->at(x, y) = c;
    }
    SkyDescription d;
    d.source = "default";
    d.map = map;
    return d;
}

vec3 sky_radiance(const Sky& s, const vec3& direction) {
    if (!s.map) return s.scale;
    const dvec2 p = map_position(s, rotate(s, direction, -1)) - 0.5;
    const double fx = std::floor(p.x), fy = std::floor(p.y);
    const int x = static_cast<int>(fx), y = static_cast<int>(fy);
    const float tx = static_cast<float>(p.x - fx), ty = static_cast<float>(p.y - fy);
    const Image& m = *s.map;
    const vec3 top = glm::mix(texel(m, x, y), texel(m, x + 1, y), tx);
    const vec3 bottom = glm::mix(texel(m, x, y + 1), texel(m, x + 1, y + 1), tx);
    return s.scale * glm::mix(top, bottom, ty);
}

float sky_pdf_w(const Sky& s, const vec3& direction) {
    if (!s.map) return sphere_pdf_w;
    const ivec2 c = map_cell(s, map_position(s, rotate(s, direction, -1)));
    return static_cast<float>(cell_probability(*s.cells, c.x, c.y) / cell_solid_angle(s, c.y));
}

SkySample sample_sky(const Sky& s, const vec2& u) {
    if (!s.map) return {square_to_sphere(u), sphere_pdf_w};
    const CellSample c = sample_cell(*s.cells, u);
    const double phi = 2 * glm::pi<double>() * ((c.x + double(c.inside.x)) / s.map->width - 0.5);
    const double upper = row_cosine(s, c.y), lower = row_cosine(s, c.y + 1);
    const double y = upper + (lower - upper) * c.inside.y;
    const double r = std::sqrt(std::max(0.0, (1 - y) * (1 + y)));
    const vec3 d(static_cast<float>(r * std::sin(phi)), static_cast<float>(y),
                 static_cast<float>(-r * std::cos(phi)));
    return {rotate(s, d, 1), static_cast<float>(c.probability / cell_solid_angle(s, c.y))};
}

}  // namespace midway
