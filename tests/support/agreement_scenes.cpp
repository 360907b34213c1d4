#include "support/agreement_scenes.h"

#include <cmath>
#include <stdexcept>

#include "math/warp.h"

namespace midway::test {
namespace {

dmat4 placed(const dvec3& at) {
    dmat4 m(1.0);
    m[3] = dvec4(at, 1);
    return m;
}

// Looks from `at` to `target` along -z, as lights and cameras do.
dmat4 aimed(const dvec3& at, const dvec3& target) { return look_at({}, at, target).to_world; }

// A rectangle about the origin in the xy plane that faces +z.
Mesh rectangle(float width, float height) {
    Mesh m;
    const float x = width / 2, y = height / 2;
    m.positions = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}};
    m.normals.assign(4, vec3(0, 0, 1));
    m.tangents.assign(4, vec4(1, 0, 0, 1));
    m.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    m.triangles = {{0, 1, 2}, {0, 2, 3}};
    return m;
}

Mesh sphere(float radius, int rows) {
    Mesh m;
    const int columns = 2 * rows;
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const float theta = pi * i / rows, phi = 2 * pi * j / columns;
            const vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta),
                         -std::sin(theta) * std::sin(phi));
            m.normals.push_back(n);
            m.positions.push_back(n * radius);
        }
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const unsigned a = i * columns + j, b = i * columns + (j + 1) % columns;
            if (i > 0) m.triangles.emplace_back(a, a + columns, b);
            if (i + 1 < rows) m.triangles.emplace_back(b, a + columns, b + columns);
        }
    return m;
}

Material lambert(const vec3& color) {
    Material m;
    m.base_color = color;
    m.metallic = 0;
    m.specular = 0;
    return m;
}

Material plastic(const vec3& color, float roughness) {
    Material m = lambert(color);
    m.specular = 1;
    m.roughness = roughness;
    return m;
}

Material metal(const vec3& color, float roughness) {
    Material m;
    m.base_color = color;
    m.roughness = roughness;
    return m;
}

Material glass(float roughness, bool solid) {
    Material m = plastic(vec3(0.9f, 0.95f, 1), roughness);
    m.transmission = 1;
    m.has_thickness = solid;
    return m;
}

struct Builder {
    SceneDescription d;
    CameraDescription camera;

    Builder() {
        camera.yfov = 0.75;
        camera = look_at(camera, {0, 1.3, 3.6}, {0, 0.62, 0});
    }
    void add(Mesh mesh, Material material, const dmat4& to_world) {
        d.instances.push_back({"", int(d.meshes.size()), int(d.materials.size()), to_world});
        d.meshes.push_back(std::make_shared<Mesh>(std::move(mesh)));
        d.materials.push_back(std::move(material));
    }
    void add_floor() {
        add(rectangle(4, 4), lambert({0.7f, 0.6f, 0.5f}), aimed({0, 0, 0}, {0, -1, 0}));
    }
    // An upright panel behind the middle; floats above the floor.
    void add_panel() {
        add(rectangle(2.2f, 1.2f), lambert({0.4f, 0.6f, 0.7f}), placed({0, 1.0, -1.1}));
    }
    void add_ball(Material m, int rows = 24) {
        add(sphere(0.5f, rows), std::move(m), placed({0, 0.75, 0.1}));
    }
    void add_lamp(float size = 0.9f) {
        Material m = lambert({0.2f, 0.2f, 0.2f});
        m.emission = vec3(6, 5, 4);
        add(rectangle(size, size), m, aimed({0.4, 2.6, 0.6}, {0.2, 0, 0}) * flip());
    }
    // aimed() looks along -z while a rectangle faces +z.
    static dmat4 flip() {
        dmat4 m(1.0);
        m[0][0] = m[2][2] = -1;
        return m;
    }
    PunctualLight& add_light(PunctualKind kind, float intensity) {
        PunctualLight l;
        l.kind = kind;
        l.intensity = intensity;
        l.color = vec3(1, 0.9f, 0.7f);
        l.to_world = aimed({0.5, 2.5, 0.9}, {0, 0.3, 0});
        d.lights.push_back(l);
        return d.lights.back();
    }
    void add_sky(bool map) {
        SkyDescription sky;
        sky.color = vec3(0.5f, 0.7f, 1);
        if (map) {
            auto image = std::make_shared<Image>();
            image->width = 16;
            image->height = 8;
            image->pixels.assign(16 * 8, vec3(0.2f, 0.3f, 0.5f));
            image->pixels[1 * 16 + 10] = vec3(20, 18, 12);
            for (int x = 0; x < 16; ++x) image->pixels[7 * 16 + x] = vec3(0);
            sky.map = image;
            sky.color = vec3(1);
        }
        d.sky = sky;
    }
    int add_texture(const std::vector<std::array<std::uint8_t, 4>>& texels, int width) {
        auto t = std::make_shared<TextureImage>();
        t->width = width;
        t->height = static_cast<int>(texels.size()) / width;
        for (const auto& p : texels) t->rgba.insert(t->rgba.end(), p.begin(), p.end());
        d.images.push_back(t);
        return static_cast<int>(d.images.size()) - 1;
    }
    AgreementScene finish(const std::string& name) {
        AgreementScene s;
        s.name = name;
        std::vector<std::string> warnings;
        s.scene = std::make_shared<Scene>(build_scene(d, warnings));
        s.camera = camera;
        return s;
    }
};

using Make = void (*)(Builder&);

// Floor, panel and a glossy ball under the light that the case adds.
void furnish(Builder& b) {
    b.add_floor();
    b.add_panel();
    b.add_ball(plastic({0.6f, 0.3f, 0.2f}, 0.4f));
}

void five_lights(Builder& b) {
    furnish(b);
    b.add_light(PunctualKind::point, 0.6f).to_world = placed({-1.2, 2.2, 0.5});
    b.add_light(PunctualKind::spot, 3.0f).outer_cone_angle = 0.5f;
    b.add_light(PunctualKind::directional, 0.7f);
    b.add_lamp();
    b.add_sky(true);
}

void surface(Builder& b, const Material& m) {
    b.add_floor();
    b.add_panel();
    b.add_ball(m);
    b.add_lamp();
}

// A window before the panel.
void sheet(Builder& b, const Material& m) {
    b.add_floor();
    b.add_panel();
    b.add_lamp();
    b.add(rectangle(1.4f, 0.9f), m, aimed({0, 0.75, 0.2}, {0.3, 0.8, -1}));
}

// A leaf between lamp and floor and one before the panel, half transparent by factor and texture.
void leaf(Builder& b) {
    b.add_floor();
    b.add_panel();
    b.add_lamp();
    Material m = plastic({0.3f, 0.7f, 0.2f}, 0.5f);
    m.alpha_mode = AlphaMode::blend;
    m.alpha = 0.7f;
    m.double_sided = true;
    m.base_color_texture.image = b.add_texture(
        {{255, 255, 255, 255}, {255, 200, 100, 90}, {200, 255, 0, 20}, {255, 255, 255, 160}}, 2);
    b.add(rectangle(1.0f, 1.0f), m, aimed({0.2, 1.3, 0.3}, {0.1, 0, 0.2}));
    b.add(rectangle(0.8f, 0.8f), m, placed({-0.4, 0.7, -0.5}));
}

void shading_normals(Builder& b) {
    b.add_floor();
    b.add_lamp();
    b.add_ball(plastic({0.6f, 0.5f, 0.3f}, 0.35f), 5);
    Material m = plastic({0.5f, 0.6f, 0.7f}, 0.4f);
    m.normal_texture.image = b.add_texture(
        {{128, 128, 255, 255}, {190, 128, 220, 255}, {128, 60, 220, 255}, {90, 170, 230, 255}}, 2);
    b.add(rectangle(2.2f, 1.2f), m, placed({0, 1.0, -1.1}));
}

// Smooth normals over few triangles, on a body that scatters by delta lobes or narrow ones.
void coarse(Builder& b, const Material& m) {
    b.add_floor();
    b.add_panel();
    b.add_lamp();
    b.add_ball(m, 5);
}

void textured_lamp(Builder& b) {
    furnish(b);
    Material m = lambert(vec3(0.3f));
    m.emission = vec3(9);
    m.double_sided = true;
    m.emission_texture.image = b.add_texture(
        {{255, 60, 20, 255}, {0, 0, 0, 255}, {40, 90, 255, 255}, {255, 255, 200, 255}}, 2);
    b.add(rectangle(1.2f, 1.0f), m, aimed({0.4, 2.6, 0.6}, {0.2, 0, 0}) * Builder::flip());
}

void thin_lens(Builder& b) {
    furnish(b);
    b.add_lamp();
    b.camera.aperture_radius = 0.15;
    b.camera.focus_distance = 3.0;
}

void camera_in_glass(Builder& b) {
    furnish(b);
    b.add_lamp();
    b.add(sphere(1.2f, 24), glass(0.9f, true), placed({0, 1.3, 3.6}));
}

// Light is made inside smooth glass and seen outside: radiance falls by eta^2 on its way, power
// not.
void lamp_in_glass(Builder& b) {
    b.add_floor();
    b.add_panel();
    b.add_ball(glass(0, true));
    Material m = lambert(vec3(0.3f));
    m.emission = vec3(6, 5, 4);
    m.double_sided = true;
    b.add(rectangle(0.5f, 0.5f), m, aimed({0, 0.75, 0.1}, {0.2, 0, 0}));
}

// A ball of smooth glass under a point light; the camera sees the floor alone.
void caustic(Builder& b) {
    b.add_floor();
    b.add_light(PunctualKind::point, 2.0f).to_world = placed({0.1, 2.4, 0.2});
    b.add(sphere(0.35f, 24), glass(0, true), placed({0, 1.7, 0.1}));
    b.camera = look_at(b.camera, {0, 1.4, 1.9}, {0, 0, 0.1});
    b.camera.yfov = 0.8;
}

struct Entry {
    std::string name;
    Make make;
    bool sees_smooth = false, caustic = false, narrow = false;
};

const std::vector<Entry>& entries() {
    static const std::vector<Entry> all = {
        {"point",
         [](Builder& b) {
             furnish(b);
             b.add_light(PunctualKind::point, 2);
         }},
        {"spot",
         [](Builder& b) {
             furnish(b);
             b.add_light(PunctualKind::spot, 6);
         }},
        {"directional",
         [](Builder& b) {
             furnish(b);
             b.add_light(PunctualKind::directional, 2);
         }},
        {"area",
         [](Builder& b) {
             furnish(b);
             b.add_lamp();
         }},
        {"sky_colour",
         [](Builder& b) {
             furnish(b);
             b.add_sky(false);
         }},
        {"sky_map",
         [](Builder& b) {
             furnish(b);
             b.add_sky(true);
         }},
        {"five_lights", five_lights},
        {"lambert",
         [](Builder& b) {
             surface(b, lambert({0.7f, 0.3f, 0.2f}));
         }},
        {"plastic",
         [](Builder& b) {
             surface(b, plastic({0.3f, 0.4f, 0.7f}, 0.25f));
         }},
        {"smooth_plastic",
         [](Builder& b) {
             surface(b, plastic({0.3f, 0.4f, 0.7f}, 0));
         },
         true},
        {"rough_metal",
         [](Builder& b) {
             surface(b, metal({0.9f, 0.7f, 0.4f}, 0.4f));
         }},
        {"smooth_metal",
         [](Builder& b) {
             surface(b, metal({0.9f, 0.7f, 0.4f}, 0));
         },
         true},
        {"rough_glass", [](Builder& b) { surface(b, glass(0.6f, true)); }},
        {"smooth_glass", [](Builder& b) { surface(b, glass(0, true)); }, true},
        {"thin_glass", [](Builder& b) { sheet(b, glass(0.4f, false)); }},
        {"smooth_thin_glass", [](Builder& b) { sheet(b, glass(0, false)); }, true},
        {"leaf", leaf},
        {"shading_normals", shading_normals},
        {"coarse_mirror",
         [](Builder& b) {
             coarse(b, metal({0.9f, 0.7f, 0.4f}, 0));
         },
         true},
        {"coarse_metal",
         [](Builder& b) {
             coarse(b, metal({0.9f, 0.7f, 0.4f}, 0.35f));
         }},
        {"coarse_glass", [](Builder& b) { coarse(b, glass(0, true)); }, true},
        {"coarse_rough_glass", [](Builder& b) { coarse(b, glass(0.6f, true)); }},
        {"textured_lamp", textured_lamp},
        {"thin_lens", thin_lens},
        {"camera_in_glass", camera_in_glass},
        {"lamp_in_glass", lamp_in_glass, true},
        {"caustic", caustic, false, true},
        {"narrow_metal",
         [](Builder& b) {
             surface(b, metal({0.9f, 0.7f, 0.4f}, 0.04f));
         },
         false, false, true},
        {"narrow_glass", [](Builder& b) { surface(b, glass(0.04f, true)); }, false, false, true},
        {"narrow_plastic",
         [](Builder& b) {
             surface(b, plastic({0.3f, 0.4f, 0.7f}, 0.033f));
         },
         false, false, true},
    };
    return all;
}

}  // namespace

std::vector<std::string> agreement_scene_names() {
    std::vector<std::string> names;
    for (const Entry& e : entries())
        if (!e.narrow) names.push_back(e.name);
    return names;
}

std::vector<std::string> oracle_scene_names() {
    std::vector<std::string> names;
    for (const Entry& e : entries()) names.push_back(e.name);
    return names;
}

AgreementScene make_agreement_scene(const std::string& name) {
    for (const Entry& e : entries()) {
        if (e.name != name) continue;
        Builder b;
        e.make(b);
        AgreementScene s = b.finish(name);
        s.sees_smooth = e.sees_smooth;
        s.caustic = e.caustic;
        return s;
    }
    throw std::runtime_error("unknown scene (" + name + "); see agreement_scene_names()");
}

}  // namespace midway::test
