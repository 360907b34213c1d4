#include "math/float_mode.h"
#include "scene/build_lights.h"
#include "scene/duplicates.h"
#include "scene/needless.h"
#include "scene/scene.h"

namespace midway {
namespace {

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

// Which of a mesh's attributes the textures of a material ask for.
struct Wanted {
    bool texcoords[2] = {false, false};
    bool tangents = false;
};

Wanted wanted_attributes(const Material& m) {
    Wanted w;
    for (const TextureRef* t : texture_refs(m))
        if (t->used()) w.texcoords[t->texcoord] = true;
    w.tangents = m.normal_texture.used();
    return w;
}

// Without those that nothing asks for: every hit would interpolate them. True where there were any.
bool drop_attributes(const Material& m, Object& o) {
    const Wanted w = wanted_attributes(m);
    bool any = false;
    const auto drop = [&](auto& values, bool wanted) {
        if (wanted || values.empty()) return;
        values = {};
        any = true;
    };
    drop(o.texcoords[0], w.texcoords[0]);
    drop(o.texcoords[1], w.texcoords[1]);
    drop(o.tangents, w.tangents);
    return any;
}

// Whether an object built for one material has all that another asks for.
bool has_attributes(const Material& built_for, const Material& m) {
    const Wanted had = wanted_attributes(built_for), wants = wanted_attributes(m);
    return (had.texcoords[0] || !wants.texcoords[0]) && (had.texcoords[1] || !wants.texcoords[1]) &&
           (had.tangents || !wants.tangents);
}

std::shared_ptr<const Geometry> build_geometry(const SceneDescription& d,
                                               const BuildOptions& options) {
    auto g = std::make_shared<Geometry>();
    if (options.normalise) g->normalisation = normalise(d);
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
        const bool spared =
            !options.needless.attributes && drop_attributes(d.materials[i.material], o);
        // Any will do that is no surface's normal.
        if (options.needless.normal_maps && o.tangents.empty())
            o.tangents.assign(o.positions.size(), {0.48f, 0.6f, 0.64f, 1});
        copy_triangles(mesh, glm::determinant(dmat3(i.to_world)) < 0, o, g->dropped);
        if (o.triangles.empty()) continue;
        g->spared_objects += spared;
        o.may_be_transparent = any_alpha(d, d.materials[i.material], mesh);
        o.closed = is_closed_mesh(o.positions, o.triangles);
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

// As far as any_alpha() looks at a material.
bool same_alpha(const Material& a, const Material& b) {
    return a.alpha_mode == b.alpha_mode && a.alpha == b.alpha && a.alpha_cutoff == b.alpha_cutoff &&
           a.base_color_texture == b.base_color_texture;
}

// Whether the geometry and its tree would come out the same for these materials.
bool still_fits(const Scene& previous, const SceneDescription& d) {
    const bool same_images = previous.textures == d.images;
    for (const Object& o : previous.geometry->objects) {
        const Instance& i = d.instances[o.instance];
        if (i.material != o.material) return false;
        const Material& m = d.materials[i.material];
        if (!has_attributes(previous.materials[i.material], m)) return false;
        if (same_images && same_alpha(m, previous.materials[i.material])) continue;
        if (any_alpha(d, m, *d.meshes[i.mesh]) != o.may_be_transparent) return false;
    }
    return true;
}

// As workers compute it where they must.
std::vector<std::optional<Bsdf>> find_even_surfaces(const Scene& s) {
    const ScopedFlushToZero flush;
    std::vector<std::optional<Bsdf>> surfaces;
    for (const Object& o : s.geometry->objects) {
        const Material& m = s.materials[o.material];
        const auto refs = texture_refs(m);
        const bool even = o.colors.empty() && std::none_of(refs.begin(), refs.end(), [&](auto* r) {
                              return r->used() && r != &m.emission_texture;
                          });
        ShadingPoint p;
        p.thin = !o.closed;
        surfaces.push_back(even ? std::optional(make_bsdf(m, s.textures, p)) : std::nullopt);
    }
    return surfaces;
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
    const NeedlessWork& needless = options.needless;
    const bool own_geometry = needless.attributes || needless.coverage || needless.normal_maps;
    if (options.previous && !own_geometry && still_fits(*options.previous, d)) {
        s.geometry = options.previous->geometry;
        s.accel = options.previous->accel;
    } else {
        s.geometry = build_geometry(d, options);
        s.accel = std::make_shared<Accel>(s.geometry, needless.coverage);
    }
    if (s.geometry->dropped > 0)
        warnings.push_back(std::to_string(s.geometry->dropped) +
                           " triangles have no area at this scale and are left out");
    if (s.geometry->duplicates > 0)
        warnings.push_back(std::to_string(s.geometry->duplicates) +
                           " triangles are there a second time and are left out");
    s.materials = d.materials;
    s.textures = d.images;
    add_needless_textures(s, needless);
    // A margin for the rounding of positions, so that the disc covers everything.
    s.radius = s.geometry->radius * (1 + 0x1p-20f);
    for (const Object& o : s.geometry->objects) s.has_transparency |= o.may_be_transparent;
    s.even_surfaces = find_even_surfaces(s);
    build_lights(s, d, options);
    return s;
}

}  // namespace midway
