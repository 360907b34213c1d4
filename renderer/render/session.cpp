#include "render/session.h"

#include <charconv>
#include <filesystem>
#include <fstream>

#include "render/session_edits.h"
#include "render/session_fields.h"

namespace midway {
namespace {

namespace fs = std::filesystem;
using Json = SessionJson;
using Fields = SessionFields;

constexpr std::string_view format_name = "midway session";
// 2: edits. A session without any is written as version 1, which older programs read.
constexpr int newest_version = 2;
constexpr std::uintmax_t most_bytes = 4 << 20;
constexpr size_t most_strategies = 4096, most_window_words = 1000;
constexpr std::uint64_t most_samples = std::uint64_t{1} << 40;

std::string from_session_folder(const std::string& session, const std::string& file) {
    const fs::path p(file);
    if (p.is_absolute()) return file;
    return (fs::path(session).parent_path() / p).string();
}

// Links are followed first: "..", taken as text, would lead elsewhere.
std::string to_session_folder(const std::string& session, const std::string& file) {
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(fs::absolute(session).parent_path(), error);
    const fs::path target = fs::absolute(file);
    const fs::path real = fs::weakly_canonical(target.parent_path(), error) / target.filename();
    const fs::path relative = real.lexically_relative(folder);
    return error || relative.empty() ? target.string() : relative.string();
}

// As prepare_scene tells colours from files.
bool is_color(const std::string& text) {
    const char* p = text.data();
    const char* end = p + text.size();
    for (int i = 0; i < 3; ++i) {
        float x = 0;
        const auto [next, error] = std::from_chars(p, end, x);
        if (error != std::errc()) return false;
        p = next;
        if (i < 2 && (p == end || *p++ != ',')) return false;
    }
    return p == end;
}

void read_camera(Fields f, SceneOptions& o) {
    f.read("name", o.camera);
    if (const Json* j = f.find("look_at")) {
        f.list("look_at", *j, 6, 6);
        o.look_at.emplace();
        for (size_t i = 0; i < 6; ++i) (*o.look_at)[i] = f.number("look_at", (*j)[i]);
    }
    f.read("fov", o.fov_degrees);
    f.read("aperture", o.aperture_radius);
    f.read("focus", o.focus_distance);
    f.warn_of_the_rest();
}

void read_lights(Fields f, SceneOptions& o, const std::string& path) {
    std::optional<std::string> color, file;
    f.read("sky_color", color);
    f.read("sky_file", file);
    if (color && !is_color(*color)) f.bad("sky_color", "is not R,G,B");
    if (color && file) f.bad("sky_file", "stands beside sky_color");
    if (color) o.sky = color;
    if (file) o.sky = from_session_folder(path, *file);
    f.read("sky_rotation", o.sky_rotation_degrees);
    f.read("sky_strength", o.sky_strength);
    f.read("lamp_strength", o.lamp_strength);
    f.warn_of_the_rest();
}

void read_strategies(Fields& f, RenderSettings& s) {
    const Json* j = f.find("only");
    if (!j) return;
    for (const Json& pair : f.list("only", *j, 0, most_strategies)) {
        f.list("only", pair, 2, 2);
        const Strategy k{f.whole("only", pair[0], 1, 10001), f.whole("only", pair[1], 0, 10001)};
        if (k.s + k.t < 2 || k == Strategy{1, 1}) f.bad("only", "holds what is no strategy");
        s.only.push_back(k);
    }
}

void read_settings(Fields f, RenderSettings& s) {
    f.read_word("technique", s.technique, parse_technique);
    if (const Json* j = f.find("exponents")) {
        s.exponents.clear();
        for (const Json& b : f.list("exponents", *j, 1, max_exponents))
            s.exponents.push_back(f.number("exponents", b));
    }
    f.read_word("families", s.families, parse_families);
    f.read_whole("width", s.width, 1, 65536);
    f.read_whole("height", s.height, 1, 65536);
    if (const Json* j = f.find("crop")) {
        f.list("crop", *j, 4, 4);
        int v[4];
        for (size_t i = 0; i < 4; ++i) v[i] = f.whole("crop", (*j)[i], 0, 65536);
        s.crop = PixelRect{v[0], v[1], v[2], v[3]};
    }
    f.read_whole("max_bounces", s.max_bounces, 0, 10000);
    f.read_whole<std::uint64_t>("seed", s.seed, 0, ~std::uint64_t{0});
    f.read_word("sampler", s.sampler, parse_sampler);
    f.read_word("filter", s.filter, parse_filter);
    f.read("clamp", s.clamp);
    if (s.clamp && !(*s.clamp > 0)) f.bad("clamp", "is not above 0");
    read_strategies(f, s);
    f.read("unweighted", s.unweighted);
    f.warn_of_the_rest();
}

void read_limits(Fields f, RenderLimits& limits) {
    if (f.find("spp")) f.read_whole<std::uint64_t>("spp", limits.spp.emplace(), 1, most_samples);
    f.read("seconds", limits.seconds);
    if (limits.seconds && !(*limits.seconds > 0)) f.bad("seconds", "is not above 0");
    f.warn_of_the_rest();
}

void read_window(Fields f, const Json& object, std::map<std::string, std::string>& window) {
    if (object.size() > most_window_words) f.bad("", "holds too much");
    for (const auto& [name, value] : object.items()) f.read(name, window[name]);
}

Json parse_file(const std::string& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error))
        throw std::runtime_error("cannot open session (" + one_line(path) + "); check the name");
    if (fs::file_size(path, error) > most_bytes || error)
        refuse_session("session is too large", path);
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in)
        throw std::runtime_error("cannot read session (" + one_line(path) +
                                 "); check its permissions");
    Json j = Json::parse(text, nullptr, false);
    if (j.is_discarded()) refuse_session("session is not valid JSON", path);
    return j;
}

Json scene_json(const Session& s, const std::string& path) {
    const SceneOptions usual, &o = s.scene;
    Json camera = Json::object(), lights = Json::object();
    if (o.camera) camera["name"] = *o.camera;
    if (o.look_at) camera["look_at"] = *o.look_at;
    if (o.fov_degrees) camera["fov"] = *o.fov_degrees;
    if (o.aperture_radius) camera["aperture"] = *o.aperture_radius;
    if (o.focus_distance) camera["focus"] = *o.focus_distance;
    if (o.sky && is_color(*o.sky)) lights["sky_color"] = *o.sky;
    if (o.sky && !is_color(*o.sky)) lights["sky_file"] = to_session_folder(path, *o.sky);
    lights["sky_rotation"] = o.sky_rotation_degrees;
    lights["sky_strength"] = o.sky_strength;
    lights["lamp_strength"] = o.lamp_strength;
    Json j;
    j["format"] = format_name;
    j["version"] = o.edits.empty() ? 1 : newest_version;
    j["scene"] = to_session_folder(path, o.path);
    j["camera"] = std::move(camera);
    j["lights"] = std::move(lights);
    if (!o.edits.empty()) j["edits"] = edits_json(o.edits);
    return j;
}

Json settings_object(const RenderSettings& s) {
    Json j;
    j["technique"] = to_string(s.technique);
    j["exponents"] = s.exponents;
    if (s.families) j["families"] = to_string(*s.families);
    j["width"] = s.width;
    j["height"] = s.height;
    if (s.crop) j["crop"] = {s.crop->x0, s.crop->y0, s.crop->x1, s.crop->y1};
    j["max_bounces"] = s.max_bounces;
    j["seed"] = s.seed;
    j["sampler"] = to_string(s.sampler);
    j["filter"] = to_string(s.filter);
    if (s.clamp) j["clamp"] = *s.clamp;
    for (const Strategy& k : s.only) j["only"].push_back({k.s, k.t});
    if (s.unweighted) j["unweighted"] = true;
    return j;
}

}  // namespace

bool is_session_path(std::string_view path) { return path.ends_with(".midway"); }

LoadedSession read_session(const std::string& path) {
    const Json j = parse_file(path);
    LoadedSession out;
    Session& s = out.session;
    if (!j.is_object() || j.value("format", Json()) != format_name)
        throw std::runtime_error("not a session (" + one_line(path) + "); give a .midway file");
    Fields f(j, "", out, path);
    f.find("format");
    int version = 0;
    f.read_whole("version", version, 0, 1 << 30);
    if (version < 1 || version > newest_version)
        throw std::runtime_error("session of another version, " + std::to_string(version) + " (" +
                                 one_line(path) + "); use the program that wrote it");
    std::string scene;
    f.read("scene", scene);
    if (scene.empty()) f.bad("scene", "does not name a file");
    s.scene.path = from_session_folder(path, scene);
    if (is_session_path(s.scene.path)) f.bad("scene", "names another session");
    const auto object = [&](const char* name) { return f.find(name); };
    if (const Json* k = object("camera")) read_camera({*k, "camera.", out, path}, s.scene);
    if (const Json* k = object("lights")) read_lights({*k, "lights.", out, path}, s.scene, path);
    if (const Json* k = object("edits")) read_edits({*k, "edits.", out, path}, s.scene.edits);
    if (const Json* k = object("render")) read_settings({*k, "render.", out, path}, s.settings);
    if (const Json* k = object("limits")) read_limits({*k, "limits.", out, path}, s.limits);
    if (const Json* k = object("window")) read_window({*k, "window.", out, path}, *k, s.window);
    f.warn_of_the_rest();
    return out;
}

void write_session(const std::string& path, const Session& s) {
    std::string text;
    try {
        Json j = scene_json(s, path);
        j["render"] = settings_object(s.settings);
        j["limits"] = Json::object();
        if (s.limits.spp) j["limits"]["spp"] = *s.limits.spp;
        if (s.limits.seconds) j["limits"]["seconds"] = *s.limits.seconds;
        j["window"] = s.window;
        if (s.window.empty()) j.erase("window");
        text = j.dump(2) + "\n";
    } catch (const Json::exception&) {
        throw std::runtime_error("a name is not UTF-8 and fits into no session (" + one_line(path) +
                                 "); rename the file");
    }
    atomic_write(path, text);
}

}  // namespace midway
