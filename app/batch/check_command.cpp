#include <fmt/format.h>

#include "check.h"
#include "render_options.h"
#include "session_options.h"

namespace midway {
namespace {

// A word of a shell command.
std::string quoted(const std::string& text) {
    const auto plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) ||
               std::string_view("_-./,:=+").find(c) != std::string_view::npos;
    };
    if (!text.empty() && std::ranges::all_of(text, plain)) return text;
    std::string s = "'";
    for (const char c : text) s += c == '\'' ? "'\\''" : std::string(1, c);
    return s + "'";
}

// The scene with all wishes that are not as the file has them.
std::string scene_words(const CheckCommand& c) {
    const SceneOptions& o = c.scene;
    std::string s = quoted(c.session.empty() ? o.path : c.session);
    if (o.sky) s += " --sky " + quoted(*o.sky);
    if (o.sky_rotation_degrees != 0) s += fmt::format(" --sky-rotation {}", o.sky_rotation_degrees);
    if (o.sky_strength != 1) s += fmt::format(" --sky-strength {}", o.sky_strength);
    if (o.lamp_strength != 1) s += fmt::format(" --lamp-strength {}", o.lamp_strength);
    if (o.camera) s += " --camera " + quoted(*o.camera);
    if (o.look_at) s += fmt::format(" --look-at {}", fmt::join(*o.look_at, ","));
    if (o.fov_degrees) s += fmt::format(" --fov {}", *o.fov_degrees);
    if (o.aperture_radius) s += fmt::format(" --aperture {}", *o.aperture_radius);
    if (o.focus_distance) s += fmt::format(" --focus {}", *o.focus_distance);
    return s;
}

std::string settings_words(const RenderSettings& s) {
    return fmt::format("--size {}x{} --max-bounces {} --seed {}", s.width, s.height, s.max_bounces,
                       s.seed);
}

int run(CheckCommand& c, const std::string& size, const CLI::App& options) {
    parse_size(size, c.settings);
    const std::string typed = c.scene.path;
    if (take_session(options, c.scene, c.quiet || c.json)) c.session = typed;
    if (c.scene.path.empty()) return check_suite(c);
    if (!c.only.empty()) usage("--only: names cases of the suite; leave the scene out");
    return check_scene(c);
}

}  // namespace

std::string replay_command(const CheckCommand& c, const AuditPlace& p) {
    return fmt::format("midway render {} {} --exponent {} --debug-pixel {},{},{}", scene_words(c),
                       settings_words(c.settings), fmt::join(audited_exponents, ","), p.x, p.y,
                       p.pass);
}

std::string check_command_line(const CheckCommand& c) {
    return fmt::format("midway check {} {} --paths {} --rays {}", scene_words(c),
                       settings_words(c.settings), c.audit.paths, c.audit.rays);
}

Command add_check_command(CLI::App& app) {
    auto c = std::make_shared<CheckCommand>();
    auto size = std::make_shared<std::string>("128x128");
    CLI::App& sub = *app.add_subcommand(
        "check", "Numerical audit of a scene; without one, the built-in suite of extreme cases");
    add_scene_options(sub, c->scene);
    sub.get_option("scene")->required(false);
    sub.add_flag("--json", c->json, "Print JSON");
    sub.add_option("--report", c->report, "HTML report");
    sub.add_option("--paths", c->audit.paths, "Paths to draw, at least")
        ->check(whole_number(1, 1'000'000'000'000))
        ->capture_default_str();
    sub.add_option("--rays", c->audit.rays, "Rays to trace back, at least; 0: none")
        ->check(whole_number(0, 1'000'000'000'000))
        ->capture_default_str();
    sub.add_option("--size", *size, "Image size WxH of the paths")->capture_default_str();
    sub.add_option("--max-bounces", c->settings.max_bounces, "Longest path, scattering events")
        ->capture_default_str();
    sub.add_option("--seed", c->settings.seed, "Seed of the random numbers")
        ->check(whole_number(0, ~std::uint64_t{0}));
    sub.add_option("--only", c->only, "GROUP or GROUP/CASE of the suite");
    sub.add_option("--effort", c->effort, "Factor on the suite's samples")
        ->check(positive_number());
    sub.add_option("--assets", c->assets, "Folder of the project's scenes, for the suite");
    add_threads_option(sub, c->audit.threads);
    sub.add_flag("--quiet", c->quiet, "No progress, no warnings");
    return [c, size, &sub] { return run(*c, *size, sub); };
}

}  // namespace midway
