#include "report/extreme_scenes.h"

#include <map>
#include <numbers>

#include "math/frame.h"
#include "scene/camera.h"

namespace midway::extreme {
namespace {

struct Solid {
    std::vector<dvec3> points;
    std::vector<uvec3> triangles;
};

Solid icosahedron() {
    const double g = std::numbers::phi;
    Solid s;
    s.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (dvec3& p : s.points) p = glm::normalize(p);
    s.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    return s;
}

void subdivide(Solid& s) {
    std::map<std::pair<unsigned, unsigned>, unsigned> middles;
    const auto middle = [&](unsigned a, unsigned b) {
        const auto [at, added] =
            middles.emplace(std::minmax(a, b), static_cast<unsigned>(s.points.size()));
        if (added) s.points.push_back(glm::normalize(s.points[a] + s.points[b]));
        return at->second;
    };
    std::vector<uvec3> finer;
    for (const uvec3& t : s.triangles) {
        const unsigned a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
        finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    s.triangles = std::move(finer);
}

// A node whose -z looks along `direction`.
dmat4 node(const vec3& position, const vec3& direction) {
    return look_at({}, dvec3(position), dvec3(position) + dvec3(direction)).to_world;
}

}  // namespace

Mesh make_quad(const vec3& corner, const vec3& u, const vec3& v, int n) {
    Mesh m;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const vec2 uv(float(i) / n, float(j) / n);
            m.positions.push_back(corner + u * uv.x + v * uv.y);
            m.texcoords[0].push_back(uv);
            m.tangents.emplace_back(glm::normalize(u), 1.0f);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const unsigned a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            m.triangles.emplace_back(a, b, d);
            m.triangles.emplace_back(a, d, c);
        }
    return m;
}

Mesh make_disc(const vec3& center, const vec3& normal, float radius, int segments) {
    const double step = 2 * std::numbers::pi / segments;
    const double r = radius * std::sqrt(step / std::sin(step));
    const Frame f = frame_from_normal(glm::normalize(normal));
    Mesh m;
    m.positions.push_back(center);
    for (int i = 0; i < segments; ++i) {
        m.positions.push_back(center + f.s * float(r * std::cos(i * step)) +
                              f.t * float(r * std::sin(i * step)));
        m.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % segments);
    }
    return m;
}

Mesh make_icosphere(const vec3& center, float radius, int subdivisions, bool inward, bool normals) {
    Solid s = icosahedron();
    for (int i = 0; i < subdivisions; ++i) subdivide(s);
    Mesh m;
    for (const dvec3& p : s.points) {
        m.positions.push_back(vec3(dvec3(center) + p * double(radius)));
        if (normals) m.normals.push_back(inward ? -vec3(p) : vec3(p));
    }
    for (uvec3 t : s.triangles) {
        if (inward) std::swap(t.y, t.z);
        m.triangles.push_back(t);
    }
    return m;
}

Material lambert(const vec3& albedo) {
    Material m;
    m.base_color = albedo;
    m.metallic = 0;
    m.specular = 0;
    return m;
}

Material metal(float roughness, const vec3& color) {
    Material m;
    m.base_color = color;
    m.roughness = roughness;
    return m;
}

Material plastic(float roughness, const vec3& color) {
    Material m = metal(roughness, color);
    m.metallic = 0;
    return m;
}

Material glass(float roughness, float ior) {
    Material m = plastic(roughness);
    m.transmission = 1;
    m.ior = ior;
    return m;
}

Material lamp(const vec3& radiance, const vec3& albedo) {
    Material m = lambert(albedo);
    m.emission = radiance;
    return m;
}

PunctualLight point_light(const vec3& position, float intensity) {
    PunctualLight l;
    l.intensity = intensity;
    l.to_world = node(position, {0, 0, -1});
    return l;
}

PunctualLight spot_light(const vec3& position, const vec3& target, float intensity, float inner,
                         float outer) {
    PunctualLight l = point_light(position, intensity);
    l.kind = PunctualKind::spot;
    l.inner_cone_angle = inner;
    l.outer_cone_angle = outer;
    l.to_world = node(position, target - position);
    return l;
}

PunctualLight sun(const vec3& travel, float irradiance) {
    PunctualLight l;
    l.kind = PunctualKind::directional;
    l.intensity = irradiance;
    l.to_world = node(vec3(0), travel);
    return l;
}

SkyDescription constant_sky(const vec3& radiance) {
    SkyDescription d;
    d.source = "colour";
    d.color = radiance;
    return d;
}

int add(SceneDescription& scene, Mesh mesh, const Material& material, const dmat4& to_world) {
    const int id = static_cast<int>(scene.instances.size());
    scene.instances.push_back({"object " + std::to_string(id),
                               static_cast<int>(scene.meshes.size()),
                               static_cast<int>(scene.materials.size()), to_world});
    scene.meshes.push_back(std::make_shared<Mesh>(std::move(mesh)));
    scene.materials.push_back(material);
    return id;
}

CameraDescription camera_at(const vec3& eye, const vec3& target, double yfov) {
    CameraDescription c;
    c.yfov = yfov;
    return look_at(c, dvec3(eye), dvec3(target));
}

}  // namespace midway::extreme
