#include "render/prepare.h"

#include <charconv>
#include <chrono>
#include <stdexcept>

#include "image/file.h"
#include "io/gltf.h"
#include "math/hash.h"

namespace midway {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t most_edit_warnings = 20;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::optional<vec3> parse_color(const std::string& text) {
    vec3 c;
    const char* p = text.data();
    const char* end = p + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [next, error] = std::from_chars(p, end, c[i]);
        if (error != std::errc()) return {};
        p = next;
        if (i < 2 && (p == end || *p++ != ',')) return {};
    }
    if (p != end) return {};
    return c;
}

SkyDescription chosen_sky(const std::string& text) {
    SkyDescription sky;
    if (const std::optional<vec3> color = parse_color(text)) {
        if (!is_finite(*color) || color->x < 0 || color->y < 0 || color->z < 0)
            throw std::invalid_argument("sky colour is negative or not finite (--sky " + text +
                                        "); give three numbers from 0 up");
        sky.source = "colour";
        sky.color = *color;
        return sky;
    }
    sky.source = text;
    sky.map = std::make_shared<Image>(read_image(text).image);
    return sky;
}

bool has_lamp(const SceneDescription& d) {
    for (const PunctualLight& l : d.lights)
        if (l.intensity > 0 && max_component(l.color) > 0) return true;
    for (const Instance& i : d.instances)
        if (max_component(d.materials[i.material].emission) > 0) return true;
    return false;
}

CameraDescription named_camera(const SceneDescription& d, const std::string& name) {
    for (const CameraDescription& c : d.cameras)
        if (c.name == name) return c;
    size_t index = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (error == std::errc() && end == name.data() + name.size() && index < d.cameras.size())
        return d.cameras[index];
    std::string known;
    for (const CameraDescription& c : d.cameras)
        known += (known.empty() ? "" : ", ") + ("\"" + c.name + "\"");
    throw std::runtime_error(
        "no camera \"" + name + "\" (" + d.source + "); " +
        (known.empty() ? "the file has no camera, leave --camera out" : "use one of " + known));
}

CameraDescription choose_camera(const SceneOptions& o, PreparedScene& p) {
    const SceneDescription& d = p.description;
    CameraDescription c;
    if (o.camera) {
        c = named_camera(d, *o.camera);
    } else if (!d.cameras.empty()) {
        c = d.cameras.front();
    } else {
        const Bounds b = scene_bounds(d).value_or(Bounds{dvec3(-0.5), dvec3(0.5)});
        c = frame_scene(b.lower, b.upper);
        if (!o.look_at) p.warnings.push_back("the file has no camera; the whole scene is framed");
    }
    if (o.look_at) {
        const auto& v = *o.look_at;
        const dvec3 eye(v[0], v[1], v[2]), target(v[3], v[4], v[5]);
        if (!(glm::length(eye - target) > 0 && glm::length(eye - target) < 1e30))
            throw std::invalid_argument(
                "camera and target are not two finite points (--look-at); give two points");
        c = look_at(c, eye, target);
    }
    if (o.fov_degrees) {
        if (!(*o.fov_degrees > 0 && *o.fov_degrees < 180))
            throw std::invalid_argument("field of view out of range (--fov); use 0 to 180 degrees");
        c.yfov = glm::radians(*o.fov_degrees);
    }
    if (o.aperture_radius) c.aperture_radius = *o.aperture_radius;
    if (o.focus_distance) c.focus_distance = *o.focus_distance;
    const auto usable = [](double x) { return x >= 0 && std::isfinite(x); };
    if (!usable(c.aperture_radius) || !usable(c.focus_distance))
        throw std::invalid_argument("negative lens (--aperture, --focus); use numbers from 0 up");
    return c;
}

void check_lights(const SceneOptions& o) {
    const auto usable = [](double x) { return x >= 0 && std::isfinite(x); };
    if (!usable(o.lamp_strength) || !usable(o.sky_strength) ||
        !std::isfinite(o.sky_rotation_degrees))
        throw std::invalid_argument(
            "strength or rotation out of range (--lamp-strength, --sky-strength, --sky-rotation); "
            "use finite numbers");
    check_edits(o.edits);
}

// Calls use(edit, place) for every edit that has one, and warns of the others.
template <class Edit, class Item, class Use>
void for_each_edit(const std::vector<Edit>& edits, const std::vector<Item>& items, const char* what,
                   std::vector<std::string>& warnings, const Use& use) {
    const std::vector<int> at = places(edits, items);
    for (size_t k = 0; k < edits.size(); ++k) {
        if (at[k] >= 0)
            use(edits[k], static_cast<size_t>(at[k]));
        else if (warnings.size() < most_edit_warnings)
            warnings.push_back(std::string("edit of ") + what + " \"" + one_line(edits[k].name) +
                               "\" left out: the file holds none of this name at its place");
    }
}

// The file's lights and materials with the edits. A lamp that is switched off is still a lamp:
// no default sky takes its place.
void choose_contents(const SceneOptions& o, PreparedScene& p) {
    SceneDescription& d = p.description;
    d.materials = p.file->materials;
    d.lights = p.file->lights;
    const auto for_lights = [&](std::vector<std::string>& warnings, const auto& use) {
        for_each_edit(o.edits.lights, d.lights, "light", warnings, use);
    };
    const auto for_materials = [&](std::vector<std::string>& warnings, const auto& use) {
        for_each_edit(o.edits.materials, d.materials, "material", warnings, use);
    };
    for_lights(p.light_warnings,
               [&](const LightEdit& e, size_t k) { d.lights[k] = values_of(d.lights[k], e); });
    for_materials(p.light_warnings, [&](const MaterialEdit& e, size_t k) {
        d.materials[k] = values_of(d.materials[k], e);
    });
    p.default_sky = !o.sky && !p.file->shines && !has_lamp(d);
    std::vector<std::string> told;
    for_lights(told,
               [&](const LightEdit& e, size_t k) { d.lights[k] = edited(p.file->lights[k], e); });
    for_materials(told, [&](const MaterialEdit& e, size_t k) {
        d.materials[k] = edited(p.file->materials[k], e);
    });
}

// `old` is of the same file, or null. glTF files hold no sky.
void choose_sky(const SceneOptions& o, const PreparedScene* old, PreparedScene& p) {
    SceneDescription& d = p.description;
    if (p.default_sky) {
        p.light_warnings.push_back(
            "the scene has no light; a soft default sky is used (--sky changes it)");
        if (!old || !old->default_sky) p.sky = default_sky();
    } else if (!o.sky) {
        p.sky.reset();
    } else if (!old || old->options.sky != o.sky) {
        p.sky = chosen_sky(*o.sky);
    }
    d.sky.reset();
    if (!p.sky || !o.edits.sky.on) return;
    d.sky = p.sky;
    d.sky->color = o.edits.sky.color.value_or(d.sky->color);
    d.sky->rotation_degrees = o.sky_rotation_degrees;
    d.sky->strength = o.sky_strength;
}

void choose_lights(const SceneOptions& o, const PreparedScene* old, PreparedScene& p) {
    check_lights(o);
    p.light_warnings.clear();
    choose_contents(o, p);
    choose_sky(o, old, p);
    p.description.lamp_strength = o.lamp_strength;
}

// Freezes the description; `previous` is a Scene of the same file to share with, or null.
void build(PreparedScene& p, const Scene* previous) {
    BuildOptions options;
    options.previous = previous;
    p.scene_warnings.clear();
    p.scene = std::make_shared<Scene>(build_scene(p.description, p.scene_warnings, options));
    if (p.scene->geometry->triangle_count == 0)
        p.scene_warnings.push_back("the scene holds no triangles; only the sky can be seen");
}

void finish(PreparedScene& p) {
    for (const auto* list : {&p.light_warnings, &p.scene_warnings})
        p.warnings.insert(p.warnings.end(), list->begin(), list->end());
    const SceneDescription& d = p.description;
    p.hash = hash_scene(d.sky && d.sky->map ? p.sky_hash : p.content_hash, d, p.camera);
}

const Image* sky_map(const PreparedScene& p) { return p.sky ? p.sky->map.get() : nullptr; }

void hash_sky(PreparedScene& p) {
    if (const Image* map = sky_map(p)) p.sky_hash = hash_sky_map(p.content_hash, *map);
}

}  // namespace

bool same_scene(const SceneOptions& a, const SceneOptions& b) {
    return a.sky == b.sky && a.sky_rotation_degrees == b.sky_rotation_degrees &&
           a.sky_strength == b.sky_strength && a.lamp_strength == b.lamp_strength &&
           a.edits == b.edits;
}

SceneOptions with_camera_of(const SceneOptions& wishes, SceneOptions old) {
    old.camera = wishes.camera;
    old.look_at = wishes.look_at;
    old.fov_degrees = wishes.fov_degrees;
    old.aperture_radius = wishes.aperture_radius;
    old.focus_distance = wishes.focus_distance;
    return old;
}

SceneOptions with_scene_of(const SceneOptions& wishes, SceneOptions old) {
    SceneOptions o = with_camera_of(old, wishes);
    o.path = std::move(old.path);
    return o;
}

PreparedScene prepare_scene(const SceneOptions& o, const LoadProgress& progress) {
    const auto at = [&](const char* stage, double done) {
        if (progress) progress(stage, done);
    };
    PreparedScene p;
    p.options = o;
    const auto start = Clock::now();
    at("reading the file", 0);
    p.description = load_gltf(o.path);
    p.warnings = p.description.warnings;
    p.file = std::make_shared<const FileContents>(
        FileContents{p.description.materials, p.description.lights, has_lamp(p.description)});
    choose_lights(o, nullptr, p);
    p.camera = choose_camera(o, p);
    p.seconds_load = seconds_since(start);
    const auto began = Clock::now();
    at("building the tree", 0.6);
    build(p, nullptr);
    at("fingerprinting", 0.95);
    p.content_hash = hash_content(p.description);
    hash_sky(p);
    finish(p);
    p.seconds_build = seconds_since(began);
    at("ready", 1);
    return p;
}

PreparedScene update_scene(const PreparedScene& old, const SceneOptions& o,
                           const LoadProgress& progress) {
    const auto at = [&](const char* stage, double done) {
        if (progress) progress(stage, done);
    };
    if (o.path != old.options.path)
        throw std::invalid_argument("the scene is another file (" + o.path + "); load it");
    PreparedScene p = old;
    p.options = o;
    p.warnings = p.description.warnings;
    const auto began = Clock::now();
    if (!same_scene(o, old.options)) {
        at("reading the sky", 0);
        choose_lights(o, &old, p);
        at("building the lights", 0.3);
        build(p, old.scene.get());
        at("fingerprinting", 0.7);
        if (sky_map(p) != sky_map(old)) hash_sky(p);
    }
    p.camera = choose_camera(o, p);
    finish(p);
    p.seconds_build = seconds_since(began);
    at("ready", 1);
    return p;
}

}  // namespace midway
