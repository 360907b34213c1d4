#include "files.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "display_maths.h"
#include "image/png.h"
#include "math/hash.h"
#include "render/command_line.h"
#include "render/film_file.h"
#include "render/image_metadata.h"
#include "script_set.h"
#include "strategy_view.h"

namespace midway {
namespace {

namespace fs = std::filesystem;

constexpr size_t recent_files = 12;

std::string ending(const std::string& path) {
    std::string e = fs::path(path).extension().string();
    std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return std::tolower(c); });
    return e;
}

// Settings of the shown image alone, of all that were made from the same paths.
RenderSettings shown_settings(const App& app, const SubmittedJob& job) {
    RenderSettings s = job.settings;
    s.exponents = {s.exponents[std::min(shown_exponent(app), s.exponents.size() - 1)]};
    return s;
}

bool has_whole_pass(const App& app, const Engine& engine) {
    return app.snapshot && app.snapshot->scale == 1 && !app.snapshot->images.empty() &&
           shown_job(app, engine) == &engine.jobs.back();
}

// The image as midway render writes it.
void save_exr(App& app, Engine& engine, const std::string& path) {
    const SubmittedJob& job = *shown_job(app, engine);
    const RenderSettings settings = shown_settings(app, job);
    const Snapshot& s = *app.snapshot;
    Metadata metadata = image_metadata(*job.prepared, settings, s.passes, s.statistics.clamped);
    set_exponent(metadata, settings.exponents.front());
    // A file that says how it was made holds what midway render makes.
    const std::string whole =
        shows_strategies(app) ? ": the whole image (a .png holds the strategies as seen)" : "";
    engine.tasks.submit([path, whole, metadata = std::move(metadata),
                         image = s.images[std::min(shown_exponent(app), s.images.size() - 1)]] {
        write_exr(path, {{"", *image}}, metadata);
        return "saved " + path + whole;
    });
}

// The channel that is shown, in the colours that are shown.
void save_png(App& app, Engine& engine, const std::string& path) {
    ShownImage shown = shown_image(app);
    if (!shown.image)
        throw std::runtime_error("there is no image yet (" + path + "); wait for one");
    engine.tasks.submit([path, shown = std::move(shown)] {
        write_encoded_png(path, shown_colours(shown));
        return "saved " + path;
    });
}

void save_image(App& app, Engine& engine, const std::string& path) {
    const std::string e = ending(path);
    if (e != ".exr" && e != ".png")
        throw std::runtime_error("unknown kind of image (" + path + "); use .exr or .png");
    if (!app.document.prepared)
        throw std::runtime_error("nothing to save (" + path + "); open a scene first");
    if (!has_whole_pass(app, engine)) {
        engine.save_later = path;
        return;
    }
    e == ".exr" ? save_exr(app, engine, path) : save_png(app, engine, path);
}

void save_session(App& app, Engine& engine, const std::string& path) {
    if (!is_session_path(path))
        throw std::runtime_error("not a session's name (" + path + "); use .midway");
    if (!app.document.prepared)
        throw std::runtime_error("nothing to save (" + path + "); open a scene first");
    Session session;
    session.scene = app.document.options;
    session.settings = job_settings(app.render);
    session.limits = app.render.limits;
    session.window = window_values(app);
    engine.tasks.submit([path, session = std::move(session)] {
        write_session(path, session);
        return "saved " + path;
    });
}

void set_sky(App& app, Engine& engine, const std::string& text) {
    if (!app.document.prepared)
        throw std::runtime_error("no scene to light (" + text + "); open a scene first");
    SceneOptions& o = app.document.options;
    o.sky.reset();
    o.edits.sky = {};
    if (!text.empty())
        o.sky = fs::exists(text) ? fs::absolute(text).lexically_normal() : fs::path(text);
    apply(app, engine, {.scene = true}, Engine::Clock::now());
}

void copy_command_line(App& app, Engine& engine) {
    const std::string line = command_line_of(app, engine);
    if (line.empty())
        throw std::runtime_error("no image to copy a command for (window); open a scene first");
    ImGui::SetClipboardText(line.c_str());
    notify(app, "copied: " + line, ImGui::GetTime());
}

}  // namespace

void perform(App& app, Engine& engine, const Action& action) {
    try {
        app.document.error.clear();
        switch (action.kind) {
            case ActionKind::open:
                return open_document(app, engine, action.text);
            case ActionKind::set_sky:
                return set_sky(app, engine, action.text);
            case ActionKind::reload:
                return reload_document(app, engine);
            case ActionKind::save_image:
                return save_image(app, engine, action.text);
            case ActionKind::save_session:
                return save_session(app, engine, action.text);
            case ActionKind::copy_command_line:
                return copy_command_line(app, engine);
            case ActionKind::keep_image:
                return keep_image(app, engine, action.text);
            case ActionKind::load_reference:
                return load_reference_file(app, engine, action.text);
            case ActionKind::save_plot:
                if (ending(action.text) != ".csv")
                    throw std::runtime_error("unknown kind of plot (" + action.text +
                                             "); use .png or .csv");
                return save_curves(app, engine, action.text);
            case ActionKind::quit:
                return;  // the loop's
        }
    } catch (const std::exception& e) {
        app.document.error = e.what();
    }
}

void save_waiting(App& app, Engine& engine) {
    if (engine.save_later.empty() || !has_whole_pass(app, engine)) return;
    perform(app, engine, {ActionKind::save_image, std::exchange(engine.save_later, {})});
}

std::string command_line_of(const App& app, const Engine& engine) {
    const SubmittedJob* job = shown_job(app, engine);
    if (!job) return {};
    RenderLimits limits = app.render.limits;
    if (app.snapshot->scale == 1 && app.snapshot->passes > 0) limits = {app.snapshot->passes, {}};
    const SceneOptions& scene = job->prepared->options;
    const RenderSettings settings = shown_settings(app, *job);
    const std::string stem = fs::path(scene.path).stem().string();
    if (scene.edits.empty()) return command_line(scene, settings, limits, stem + ".exr");
    // The same edits have the same name: copying twice leaves one file.
    const std::string chosen = settings_json(settings);
    const std::uint64_t hash = hash_bytes(job->prepared->hash, chosen.data(), chosen.size());
    const std::string name = fmt::format("{}-{:08x}.midway", stem, hash >> 32);
    const std::string session = fs::absolute(name).string();  // the line works from any folder
    write_session(session, {scene, settings, {}, {}});
    return session_command_line(session, limits, stem + ".exr");
}

Action action_of_drop(const std::string& path) {
    const std::string e = ending(path);
    return {e == ".hdr" || e == ".exr" ? ActionKind::set_sky : ActionKind::open, path};
}

void remember_file(App& app, const std::string& path) {
    std::vector<std::string>& recent = app.ui.recent;
    std::erase(recent, path);
    recent.insert(recent.begin(), path);
    if (recent.size() > recent_files) recent.resize(recent_files);
}

}  // namespace midway
