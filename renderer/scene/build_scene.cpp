#include <cstring>
#include <stdexcept>

#include "math/hash.h"
#include "scene/duplicates.h"
#include "scene/scene.h"

namespace midway {
namespace {

constexpr double pi_d = 3.14159265358979323846;
// The share of next event's picks that is spread evenly, so that a weak lamp close by is found.
constexpr double even_share = 0.2;

double mean(const vec3& c) { return (double(c.x) + c.y + c.z) / 3; }

template <class Visit>
void for_each_position(const SceneDescription& d, const Visit& visit) {
    for (const Instance& i : d.instances)
        for (const vec3& p : d.meshes[i.mesh]->positions)
            visit(dvec3(i.to_world * dvec4(dvec3(p), 1.0)));
}

Normalisation normalise(const SceneDescription& d) {
    Normalisation n;
    const std::optional<Bounds> b = scene_bounds(d);
    if (!b) return n;
    n.center = 0.5 * (b->lower + b->upper);
    double radius2 = 0;
    for_each_position(d, [&](const dvec3& p) {
        const dvec3 v = p - n.center;
        radius2 = std::max(radius2, glm::dot(v, v));
    });
    int exponent = 0;
    if (radius2 > 0) std::frexp(std::sqrt(radius2), &exponent);
    n.scale = std::ldexp(1.0, -exponent);
    return n;
}

void transform_vertices(const Mesh& mesh, const dmat4& m, const Normalisation& n, Object& o) {
    for (const vec3& p : mesh.positions)
        o.positions.push_back(vec3((dvec3(m * dvec4(dvec3(p), 1.0)) - n.center) * n.scale));
    const dmat3 linear(m);
    // The cofactor matrix turns normals also where the transform is singular or mirrors.
    const dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                         glm::cross(linear[0], linear[1]));
    const double sign = glm::determinant(linear) < 0 ? -1 : 1;
    for (const vec3& v : mesh.normals) {
        const dvec3 t = cofactor * dvec3(v) * sign;
        const double len = glm::length(t);
        o.normals.push_back(len > 0 ? vec3(t / len) : vec3(0));
    }
    for (const vec4& v : mesh.tangents) {
        const dvec3 t = linear * dvec3(v);
        const double len = glm::length(t);
        o.tangents.emplace_back(len > 0 ? vec3(t / len) : vec3(0), sign < 0 ? -v.w : v.w);
    }
}

// A mirroring transform turns the winding round (glTF 2.0, section 3.7.4). Triangles that have no
// area left in float are dropped.
void copy_triangles(const Mesh& mesh, bool mirrored, Object& o, size_t& dropped) {
    for (uvec3 t : mesh.triangles) {
        if (mirrored) std::swap(t.y, t.z);
        o.triangles.push_back(t);
        const TriangleShape shape = triangle_shape(o, static_cast<int>(o.triangles.size()) - 1);
        if (shape.area > 0 && is_finite(shape.normal)) continue;
        o.triangles.pop_back();
        ++dropped;
    }
}

// What traversal has to know of an object's material.
struct ObjectFacts {
    bool may_be_transparent = false;
    bool closed = false;
    bool operator==(const ObjectFacts&) const = default;
};

bool any_alpha(const SceneDescription& d, const Material& m, const Mesh& mesh) {
    if (m.alpha_mode == AlphaMode::opaque) return false;
    const float limit = m.alpha_mode == AlphaMode::mask ? m.alpha_cutoff : 1.0f;
    if (m.alpha < limit) return true;
    for (const vec4& c : mesh.colors)
        if (m.alpha * c.w < limit) return true;
    if (!m.base_color_texture.used()) return false;
    const TextureImage& image = *d.images[m.base_color_texture.image];
    for (size_t i = 3; i < image.rgba.size(); i += 4)
        if (image.rgba[i] < 255) return true;
    return false;
}

ObjectFacts object_facts(const SceneDescription& d, const Object& o) {
    const Instance& i = d.instances[o.instance];
    const Material& material = d.materials[i.material];
    ObjectFacts f;
    f.may_be_transparent = any_alpha(d, material, *d.meshes[i.mesh]);
    f.closed = material.transmission > 0 &&
               (material.has_thickness || is_closed_mesh(o.positions, o.triangles));
    return f;
}

std::shared_ptr<const Geometry> build_geometry(const SceneDescription& d, bool normalised) {
    auto g = std::make_shared<Geometry>();
    if (normalised) g->normalisation = normalise(d);
    float radius2 = 0;
    for (size_t k = 0; k < d.instances.size(); ++k) {
        const Instance& i = d.instances[k];
        const Mesh& mesh = *d.meshes[i.mesh];
        Object o;
        o.name = i.name.empty() ? mesh.name : i.name;
        o.instance = static_cast<int>(k);
        o.material = i.material;
        o.texcoords = mesh.texcoords;
        o.colors = mesh.colors;
        transform_vertices(mesh, i.to_world, g->normalisation, o);
        copy_triangles(mesh, glm::determinant(dmat3(i.to_world)) < 0, o, g->dropped);
        if (o.triangles.empty()) continue;
        const ObjectFacts facts = object_facts(d, o);
        o.may_be_transparent = facts.may_be_transparent;
        o.closed = facts.closed;
        g->objects.push_back(std::move(o));
    }
    g->duplicates = remove_duplicate_triangles(g->objects);
    std::erase_if(g->objects, [](const Object& o) { return o.triangles.empty(); });
    for (const Object& o : g->objects) {
        for (const vec3& p : o.positions) radius2 = std::max(radius2, length_squared(p));
        g->triangle_count += o.triangles.size();
    }
    if (g->triangle_count > 0) g->radius = std::sqrt(radius2);
    return g;
}

// Whether the geometry and its tree would come out the same for these materials.
bool still_fits(const Geometry& g, const SceneDescription& d) {
    for (const Object& o : g.objects)
        if (d.instances[o.instance].material != o.material ||
            object_facts(d, o) != ObjectFacts{o.may_be_transparent, o.closed})
            return false;
    return true;
}

// Mean emission of a triangle, coverage included. A small share of the material's own emission
// keeps it positive wherever a texel between the probes may shine.
double mean_emission(const Scene& s, const Object& o, int object, int triangle) {
    const Material& m = s.materials[o.material];
    if (!m.emission_texture.used() && !o.may_be_transparent) return mean(m.emission);
    constexpr int n = 6;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
            const TriangleHit at{object, triangle, (i + 1 / 3.0f) / n, (j + 1 / 3.0f) / n};
            const ShadingPoint p = surface_point(o, at).shading;
            sum += mean(material_emission(m, s.textures, p)) * material_alpha(m, s.textures, p);
        }
    return sum / (n * (n + 1) / 2) + 1e-3 * mean(m.emission);
}

void add_area_lights(Scene& s, float lamp_strength) {
    s.first_light.assign(s.geometry->objects.size(), -1);
    for (Material& m : s.materials) m.emission *= lamp_strength;
    for (size_t k = 0; k < s.geometry->objects.size(); ++k) {
        const Object& o = s.geometry->objects[k];
        const Material& m = s.materials[o.material];
        if (!(mean(m.emission) > 0)) continue;
        s.first_light[k] = static_cast<int>(s.lights.size());
        for (size_t t = 0; t < o.triangles.size(); ++t) {
            const TriangleShape shape = triangle_shape(o, static_cast<int>(t));
            Light l;
            l.kind = LightKind::area;
            l.object = static_cast<int>(k);
            l.triangle = static_cast<int>(t);
            l.area = shape.area;
            l.two_sided = m.double_sided;
            l.power = pi_d * shape.area * (l.two_sided ? 2 : 1) *
                      mean_emission(s, o, l.object, l.triangle);
            s.lights.push_back(l);
        }
    }
}

Light make_punctual(const PunctualLight& d, const Scene& s, float lamp_strength) {
    const Normalisation& n = s.geometry->normalisation;
    Light l;
    const vec3 color = d.color * (d.intensity * lamp_strength);
    l.direction = vec3(-glm::normalize(dvec3(d.to_world[2])));
    if (d.kind == PunctualKind::directional) {
        l.kind = LightKind::directional;
        l.emission = color;
        l.power = mean(color) * pi_d * s.radius * s.radius;
        return l;
    }
    l.position = vec3((dvec3(d.to_world[3]) - n.center) * n.scale);
    // Irradiance is intensity over distance squared, and distances are scaled.
    l.emission = vec3(dvec3(color) * (n.scale * n.scale));
    l.kind = d.kind == PunctualKind::spot ? LightKind::spot : LightKind::point;
    double solid_angle = 4 * pi_d;
    if (d.kind == PunctualKind::spot) {
        l.cos_inner = std::cos(d.inner_cone_angle);
        l.cos_outer = std::cos(d.outer_cone_angle);
        solid_angle = 2 * pi_d * ((1.0 - l.cos_inner) + (double(l.cos_inner) - l.cos_outer) / 3);
    }
    l.power = mean(l.emission) * solid_angle;
    return l;
}

void add_sky(Scene& s, const SkyDescription& d) {
    s.sky = make_sky(d);
    if (!(s.sky->mean_radiance > 0)) return;
    Light l;
    l.kind = LightKind::sky;
    l.power = 4 * pi_d * s.sky->mean_radiance * pi_d * s.radius * s.radius;
    s.sky_light = static_cast<int>(s.lights.size());
    s.lights.push_back(l);
}

void make_light_tables(Scene& s) {
    std::vector<double> power, next_event;
    size_t shining = 0;
    for (const Light& l : s.lights) {
        power.push_back(l.power);
        s.total_power += l.power;
        shining += l.power > 0;
    }
    if (!std::isfinite(s.total_power))
        throw std::runtime_error(
            "the lights' power is not finite (emission or intensity); use smaller numbers");
    for (const Light& l : s.lights)
        next_event.push_back(l.power > 0 ? (1 - even_share) * l.power / s.total_power +
                                               even_share / double(shining)
                                         : 0.0);
    s.emission_pick = make_distribution(power);
    s.next_event_pick = make_distribution(next_event);
}

}  // namespace

std::optional<Bounds> scene_bounds(const SceneDescription& d) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    Bounds b{dvec3(inf), dvec3(-inf)};
    for_each_position(d, [&](const dvec3& p) {
        b.lower = glm::min(b.lower, p);
        b.upper = glm::max(b.upper, p);
    });
    if (!(b.lower.x <= b.upper.x)) return {};
    return b;
}

Scene build_scene(const SceneDescription& d, std::vector<std::string>& warnings,
                  const BuildOptions& options) {
    Scene s;
    if (options.previous && still_fits(*options.previous->geometry, d)) {
        s.geometry = options.previous->geometry;
        s.accel = options.previous->accel;
    } else {
        s.geometry = build_geometry(d, options.normalise);
        s.accel = std::make_shared<Accel>(s.geometry);
    }
    if (s.geometry->dropped > 0)
        warnings.push_back(std::to_string(s.geometry->dropped) +
                           " triangles have no area at this scale and are left out");
    if (s.geometry->duplicates > 0)
        warnings.push_back(std::to_string(s.geometry->duplicates) +
                           " triangles are there a second time and are left out");
    s.materials = d.materials;
    s.textures = d.images;
    // A margin for the rounding of positions, so that the disc covers everything.
    s.radius = s.geometry->radius * (1 + 0x1p-20f);
    for (const Object& o : s.geometry->objects) s.has_transparency |= o.may_be_transparent;
    add_area_lights(s, d.lamp_strength);
    for (const PunctualLight& l : d.lights)
        s.lights.push_back(make_punctual(l, s, d.lamp_strength));
    if (d.sky) add_sky(s, *d.sky);
    make_light_tables(s);
    return s;
}

}  // namespace midway
