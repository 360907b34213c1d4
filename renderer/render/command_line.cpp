#include "render/command_line.h"

#include <fmt/format.h>

#include <cstdlib>

namespace midway {
namespace {

// The shortest text that the program reads back to the same bits. It reads by way of long double,
// where the shortest text of a double may be rounded twice; then all digits are given.
std::string number(double x) {
    const std::string text = fmt::format("{}", x);
    if (static_cast<double>(std::strtold(text.c_str(), nullptr)) == x) return text;
    return fmt::format("{:.17g}", x);
}

std::string number(float x) {
    const std::string text = fmt::format("{}", x);
    if (static_cast<float>(std::strtold(text.c_str(), nullptr)) == x) return text;
    return fmt::format("{:.9g}", x);
}

template <class List>
std::string numbers(const List& list) {
    std::string text;
    for (const auto& x : list) text += (text.empty() ? "" : ",") + number(x);
    return text;
}

// A file name that cannot be taken for an option.
std::string file_word(const std::string& path) {
    return !path.empty() && path.front() == '-' ? "./" + path : path;
}

class Words {
  public:
    std::vector<std::string> list;

    void option(const std::string& name, const std::string& value) {
        // A value that begins like an option stays with its name.
        if (!value.empty() && value.front() == '-') {
            list.push_back(name + "=" + value);
        } else {
            list.push_back(name);
            list.push_back(value);
        }
    }
};

void add_scene(Words& w, const SceneOptions& o) {
    const SceneOptions usual;
    if (o.camera) w.option("--camera", *o.camera);
    if (o.look_at) w.option("--look-at", numbers(*o.look_at));
    if (o.fov_degrees) w.option("--fov", number(*o.fov_degrees));
    if (o.aperture_radius) w.option("--aperture", number(*o.aperture_radius));
    if (o.focus_distance) w.option("--focus", number(*o.focus_distance));
    if (o.sky) w.option("--sky", *o.sky);
    if (o.sky_rotation_degrees != usual.sky_rotation_degrees)
        w.option("--sky-rotation", number(o.sky_rotation_degrees));
    if (o.sky_strength != usual.sky_strength) w.option("--sky-strength", number(o.sky_strength));
    if (o.lamp_strength != usual.lamp_strength)
        w.option("--lamp-strength", number(o.lamp_strength));
}

void add_settings(Words& w, const RenderSettings& s) {
    const RenderSettings usual;
    if (s.technique != Technique::automatic)
        w.option("--technique", std::string(to_string(s.technique)));
    if (s.exponents != usual.exponents) w.option("--exponent", numbers(s.exponents));
    if (s.families) w.option("--families", to_string(*s.families));
    if (s.width != usual.width || s.height != usual.height)
        w.option("--size", fmt::format("{}x{}", s.width, s.height));
    if (s.crop)
        w.option("--crop",
                 fmt::format("{},{},{},{}", s.crop->x0, s.crop->y0, s.crop->x1, s.crop->y1));
    if (s.max_bounces != usual.max_bounces)
        w.option("--max-bounces", std::to_string(s.max_bounces));
    if (s.seed != usual.seed) w.option("--seed", std::to_string(s.seed));
    if (s.sampler != usual.sampler) w.option("--sampler", std::string(to_string(s.sampler)));
    if (s.filter != usual.filter) w.option("--filter", std::string(to_string(s.filter)));
    if (s.clamp) w.option("--clamp", number(*s.clamp));
    for (const Strategy& k : s.only) w.option("--only", fmt::format("{},{}", k.s, k.t));
    if (s.unweighted) w.list.push_back("--unweighted");
}

void add_limits(Words& w, const RenderLimits& limits) {
    if (limits.spp) w.option("--spp", std::to_string(*limits.spp));
    if (limits.seconds) w.option("--time", number(*limits.seconds));
}

std::string joined(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_quoted(word);
    return line;
}

}  // namespace

std::vector<std::string> command_words(const SceneOptions& scene, const RenderSettings& settings,
                                       const RenderLimits& limits, const std::string& output) {
    Words w;
    w.list = {"midway", "render", file_word(scene.path), "-o", file_word(output)};
    add_scene(w, scene);
    add_settings(w, settings);
    add_limits(w, limits);
    return w.list;
}

std::string command_line(const SceneOptions& scene, const RenderSettings& settings,
                         const RenderLimits& limits, const std::string& output) {
    return joined(command_words(scene, settings, limits, output));
}

std::string scene_options_line(const SceneOptions& scene) {
    Words w;
    add_scene(w, scene);
    return joined(w.list);
}

std::string session_command_line(const std::string& session, const RenderLimits& limits,
                                 const std::string& output) {
    Words w;
    w.list = {"midway", "render", file_word(session), "-o", file_word(output)};
    add_limits(w, limits);
    return joined(w.list);
}

std::string shell_quoted(const std::string& word) {
    constexpr std::string_view plain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_./,:=+@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

}  // namespace midway
