#include <fmt/format.h>

#include "check.h"
#include "render/command_line.h"
#include "render_options.h"
#include "session_options.h"

namespace midway {
namespace {

// The scene with all wishes that are not as the file has them.
std::string scene_words(const CheckCommand& c) {
    const SceneOptions& o = c.scene;
    const std::string options = scene_options_line(o);
    return shell_quoted(c.session.empty() ? o.path : c.session) + (options.empty() ? "" : " ") +
           options;
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
    // The audit draws with all families; a session would bring its own sampler and filter.
    return fmt::format(
        "midway render {} {} --technique bdpt --sampler {} --filter {} --exponent {} "
        "--debug-pixel {},{},{}",
        scene_words(c), settings_words(c.settings), to_string(c.settings.sampler),
        to_string(c.settings.filter), fmt::join(audited_exponents, ","), p.x, p.y, p.pass);
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
