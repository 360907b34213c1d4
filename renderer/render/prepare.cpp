#include "render/prepare.h"

#include <charconv>
#include <chrono>
#include <stdexcept>

#include "io/gltf.h"
#include "math/hash.h"

namespace midway {
namespace {

using Clock = std::chrono::steady_clock;

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

bool has_light(const SceneDescription& d) {
    if (d.sky) return true;
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

// `old` holds the sky of the wishes before, or null.
void choose_lights(const SceneOptions& o, const PreparedScene* old, PreparedScene& p) {
    SceneDescription& d = p.description;
    d.sky.reset();  // glTF files hold none
    if (o.sky && old && old->options.sky == o.sky) {
        d.sky = old->description.sky;
        d.sky->rotation_degrees = 0;
        d.sky->strength = 1;
    } else if (o.sky) {
        d.sky = chosen_sky(*o.sky);
    }
    p.default_sky = !has_light(d);
    if (p.default_sky) {
        d.sky = default_sky();
        p.warnings.push_back(
            "the scene has no light; a soft default sky is used (--sky changes it)");
    }
    if (d.sky) {
        d.sky->rotation_degrees += o.sky_rotation_degrees;
        d.sky->strength *= o.sky_strength;
    }
    d.lamp_strength = o.lamp_strength;
    const auto usable = [](double x) { return x >= 0 && std::isfinite(x); };
    if (!usable(o.lamp_strength) || !usable(o.sky_strength) ||
        !std::isfinite(o.sky_rotation_degrees))
        throw std::invalid_argument(
            "strength or rotation out of range (--lamp-strength, --sky-strength, --sky-rotation); "
            "use finite numbers");
}

// Whether two wishes differ in the camera alone.
bool same_lights(const SceneOptions& a, const SceneOptions& b) {
    return a.sky == b.sky && a.sky_rotation_degrees == b.sky_rotation_degrees &&
           a.sky_strength == b.sky_strength && a.lamp_strength == b.lamp_strength;
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
    p.warnings.insert(p.warnings.end(), p.scene_warnings.begin(), p.scene_warnings.end());
    p.hash = hash_scene(p.content_hash, p.description, p.camera);
}

const Image* sky_map(const SceneDescription& d) { return d.sky ? d.sky->map.get() : nullptr; }

}  // namespace

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
    choose_lights(o, nullptr, p);
    p.camera = choose_camera(o, p);
    p.seconds_load = seconds_since(start);
    const auto began = Clock::now();
    at("building the tree", 0.6);
    build(p, nullptr);
    at("fingerprinting", 0.95);
    p.content_hash = hash_content(p.description);
    finish(p);
    p.seconds_build = seconds_since(began);
    at("ready", 1);
    return p;
}

PreparedScene update_scene(const PreparedScene& old, const SceneOptions& o) {
    if (o.path != old.options.path)
        throw std::invalid_argument("the scene is another file (" + o.path + "); load it");
    PreparedScene p = old;
    p.options = o;
    p.warnings = p.description.warnings;
    choose_lights(o, &old, p);
    p.camera = choose_camera(o, p);
    const auto began = Clock::now();
    if (!same_lights(o, old.options)) build(p, old.scene.get());
    if (sky_map(p.description) != sky_map(old.description))
        p.content_hash = hash_content(p.description);
    finish(p);
    p.seconds_build = seconds_since(began);
    return p;
}

}  // namespace midway
