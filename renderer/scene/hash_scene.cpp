#include <cstring>
#include <type_traits>

#include "math/hash.h"
#include "scene/scene.h"

namespace midway {
namespace {

// Feeds values in a fixed order; padding is never read.
class Hasher {
  public:
    explicit Hasher(std::uint64_t state = 0) : state_(state) {}
    void bytes(const void* data, size_t n) { state_ = hash_bytes(state_, data, n); }
    template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void add(T v) { bytes(&v, sizeof v); }
    void add(const vec3& v) { bytes(&v, sizeof v); }
    void add(const dmat4& m) { bytes(&m, sizeof m); }
    void add(const TextureRef& t) {
        add(t.image);
        add(t.texcoord);
        add(t.wrap_u);
        add(t.wrap_v);
        add(t.nearest);
        add(t.rows[0]);
        add(t.rows[1]);
    }
    template <class T>
    void add(const std::vector<T>& v) {
        add(v.size());
        bytes(v.data(), v.size() * sizeof(T));
    }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_;
};

void add_material(Hasher& h, const Material& m) {
    h.add(m.base_color);
    h.add(m.alpha);
    h.add(m.metallic);
    h.add(m.roughness);
    h.add(m.normal_scale);
    h.add(m.emission);
    h.add(m.alpha_mode);
    h.add(m.alpha_cutoff);
    h.add(m.double_sided);
    h.add(m.transmission);
    h.add(m.ior);
    h.add(m.specular);
    h.add(m.specular_color);
    h.add(m.has_thickness);
    for (const TextureRef* t : {&m.base_color_texture, &m.metallic_roughness_texture,
                                &m.normal_texture, &m.emission_texture, &m.transmission_texture,
                                &m.specular_texture, &m.specular_color_texture})
        h.add(*t);
}

void add_mesh(Hasher& h, const Mesh& m) {
    h.add(m.positions);
    h.add(m.normals);
    h.add(m.tangents);
    h.add(m.texcoords[0]);
    h.add(m.texcoords[1]);
    h.add(m.colors);
    h.add(m.triangles);
}

void add_light(Hasher& h, const PunctualLight& l) {
    h.add(l.kind);
    h.add(l.color);
    h.add(l.intensity);
    h.add(l.inner_cone_angle);
    h.add(l.outer_cone_angle);
    h.add(l.to_world);
}

void add_sky(Hasher& h, const SkyDescription& s) {
    h.add(s.color);
    h.add(s.strength);
    h.add(s.rotation_degrees);
}

void add_camera(Hasher& h, const CameraDescription& c) {
    h.add(c.yfov);
    h.add(c.aperture_radius);
    h.add(c.focus_distance);
    h.add(c.to_world);
}

}  // namespace

std::uint64_t hash_content(const SceneDescription& d) {
    Hasher h;
    for (const auto& m : d.meshes) add_mesh(h, *m);
    for (const auto& image : d.images)
        if (image) h.add(image->rgba);
    return h.value();
}

std::uint64_t hash_sky_map(std::uint64_t content, const Image& map) {
    Hasher h(content);
    h.add(map.pixels);
    return h.value();
}

std::uint64_t hash_scene(std::uint64_t content, const SceneDescription& d,
                         const CameraDescription& camera) {
    Hasher h;
    h.add(content);
    for (const Material& m : d.materials) add_material(h, m);
    for (const Instance& i : d.instances) {
        h.add(i.mesh);
        h.add(i.material);
        h.add(i.to_world);
    }
    for (const PunctualLight& l : d.lights) add_light(h, l);
    if (d.sky) add_sky(h, *d.sky);
    h.add(d.lamp_strength);
    add_camera(h, camera);
    return h.value();
}

}  // namespace midway
