#include "session_options.h"

#include "commands.h"

namespace midway {
namespace {

// Whether an option was given; not every command has each of them.
bool given(const CLI::App& command, const char* option) {
    const CLI::Option* o = command.get_option_no_throw(option);
    return o && o->count() > 0;
}

// Takes over a value for which its option was not given.
template <class T>
void take(const CLI::App& command, const char* option, const T& from, T& to) {
    if (!given(command, option)) to = from;
}

}  // namespace

std::optional<Session> take_session(const CLI::App& command, SceneOptions& scene, bool quiet) {
    if (!is_session_path(scene.path)) return {};
    LoadedSession loaded = read_session(scene.path);
    if (!quiet) print_warnings(loaded.warnings);
    const SceneOptions& from = loaded.session.scene;
    scene.path = from.path;
    take(command, "--sky", from.sky, scene.sky);
    take(command, "--sky-rotation", from.sky_rotation_degrees, scene.sky_rotation_degrees);
    take(command, "--sky-strength", from.sky_strength, scene.sky_strength);
    take(command, "--lamp-strength", from.lamp_strength, scene.lamp_strength);
    take(command, "--fov", from.fov_degrees, scene.fov_degrees);
    take(command, "--aperture", from.aperture_radius, scene.aperture_radius);
    take(command, "--focus", from.focus_distance, scene.focus_distance);
    take(command, "--look-at", from.look_at, scene.look_at);
    take(command, "--camera", from.camera, scene.camera);
    scene.edits = from.edits;
    return std::move(loaded.session);
}

void take_settings(const CLI::App& command, const RenderSettings& from, RenderSettings& to) {
    const std::string technique =
        given(command, "--technique") ? command["--technique"]->as<std::string>() : std::string();
    if (technique.empty()) to.technique = from.technique;
    if (technique.find(':') == std::string::npos)
        take(command, "--exponent", from.exponents, to.exponents);
    take(command, "--families", from.families, to.families);
    take(command, "--size", from.width, to.width);
    take(command, "--size", from.height, to.height);
    // A crop is one of its own size.
    if (!given(command, "--size")) take(command, "--crop", from.crop, to.crop);
    take(command, "--max-bounces", from.max_bounces, to.max_bounces);
    take(command, "--seed", from.seed, to.seed);
    take(command, "--sampler", from.sampler, to.sampler);
    take(command, "--filter", from.filter, to.filter);
    take(command, "--clamp", from.clamp, to.clamp);
    take(command, "--only", from.only, to.only);
    take(command, "--unweighted", from.unweighted, to.unweighted);
}

}  // namespace midway
