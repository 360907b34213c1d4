#include "engine.h"

#include <imgui.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <utility>

#include "files.h"
#include "render/coverage.h"
#include "render/film_file.h"
#include "render/leave_outs.h"
#include "script_set.h"
#include "strategy_view.h"

namespace midway {
namespace {

constexpr size_t kept_jobs = 32;

// Takes the camera of the document's wishes; the scene stays. False where it makes no sense.
bool update_camera(Document& d) {
    try {
        d.prepared = std::make_shared<const PreparedScene>(
            update_scene(*d.prepared, with_camera_of(d.options, d.prepared->options)));
        d.error.clear();
        return true;
    } catch (const std::exception& e) {
        d.error = e.what();
        d.options = with_camera_of(d.prepared->options, d.options);
        return false;
    }
}

void update_coverage(App& app) {
    Document& d = app.document;
    d.not_covered.clear();
    d.left_out.clear();
    for (const LeaveOut& line : leave_outs(*d.prepared->scene))
        d.left_out.push_back(line.what + ": " + line.why);
    try {
        const Estimator e =
            make_estimator(*d.prepared->scene, d.prepared->camera, job_settings(app.render));
        d.not_covered = not_covered(scene_features(*d.prepared->scene), e.families, e.direct_lamps);
    } catch (const std::exception& e) {
        d.error = e.what();
    }
}

// A session's settings and the window's own words, once its scene is here.
void take_session(App& app, const Session& session) {
    app.render.settings = session.settings;
    app.render.limits = session.limits;
    app.render.fit_window = false;
    app.render.same_paths = session.settings.exponents.size() > 1;
    app.render.exponent = session.settings.exponents.front();
    for (const auto& [key, value] : session.window) {
        try {
            set_value(app, key, value);
        } catch (const std::exception& e) {
            app.document.warnings.push_back(e.what());
        }
    }
}

News take_loaded(App& app, Engine& engine) {
    std::optional<LoadResult> loaded = engine.loader.take();
    if (!loaded) return {};
    Document& d = app.document;
    const bool again = std::exchange(engine.reloading, false);
    if (!loaded->prepared) {
        d.error = loaded->error;
        engine.opening.reset();
        if (again) d.stamp = loaded->stamp;  // wait for the next change of the file
        return {true, {}};
    }
    engine.updater.forget();
    d.prepared = std::move(loaded->prepared);
    d.files = std::move(loaded->files);
    d.stamp = loaded->stamp;
    d.warnings = d.prepared->warnings;
    d.error.clear();
    if (again) {
        // The camera and the lights may have been changed since the request.
        return {true, {.camera = true, .scene = true}};
    }
    d.options = loaded->options;
    app.undo = {.now = d.options};
    d.path = engine.opening_path;
    app.camera.bookmarks.clear();
    app.display.zoom = 0;
    app.display.pan = vec2(0);
    if (engine.opening) {
        take_session(app, *engine.opening);
        engine.opening.reset();
    }
    engine.refit = true;
    remember_file(app, d.path);
    return {true, {.settings = true}};
}

News take_updated(App& app, Engine& engine) {
    const std::optional<UpdateResult> updated = engine.updater.take();
    if (!updated) return {};
    Document& d = app.document;
    if (!updated->prepared) {
        d.error = updated->error;
        d.options = with_scene_of(d.prepared->options, d.options);
        withdraw(app.undo, d.options);
        return {true, {}};
    }
    engine.scene_edited = updated->edited;
    d.prepared = updated->prepared;
    d.warnings = d.prepared->warnings;
    d.error.clear();
    return {true, {.camera = true}};
}

bool take_status(App& app, Engine& engine) {
    const LoadStatus status = engine.loader.status();
    Document& d = app.document;
    const std::string loading = status.busy ? engine.opening_path : "";
    const auto progress = static_cast<float>(status.done);
    if (d.loading == loading && d.stage == status.stage && d.progress == progress) return false;
    d.loading = loading;
    d.stage = status.stage;
    d.progress = progress;
    return true;
}

bool take_images(App& app, Engine& engine) {
    auto snapshot = engine.live.snapshot();
    auto channels = engine.live.channels();
    if (snapshot == app.snapshot && channels == app.channels) return false;
    app.snapshot = std::move(snapshot);
    // What `auto` decided belongs to what its files say.
    if (app.snapshot && app.snapshot->scale == 1 && app.snapshot->plan)
        for (SubmittedJob& job : engine.jobs)
            if (job.number == app.snapshot->job) job.settings.plan = app.snapshot->plan;
    app.channels = std::move(channels);
    if (app.snapshot && !app.snapshot->error.empty()) app.document.error = app.snapshot->error;
    return true;
}

bool same_job(const RenderChoices& a, const RenderChoices& b) {
    return a.threads == b.threads &&
           settings_json(job_settings(a)) == settings_json(job_settings(b));
}

}  // namespace

News collect(App& app, Engine& engine) {
    News news;
    for (const News& n : {take_loaded(app, engine), take_updated(app, engine)}) {
        news.visible |= n.visible;
        news.change |= n.change;
    }
    news.visible |= take_status(app, engine);
    news.visible |= take_images(app, engine);
    news.visible |= collect_inspection(app, engine);
    while (std::optional<TaskResult> done = engine.tasks.take()) {
        news.visible = true;
        if (!done->error.empty()) app.document.error = done->error;
        if (!done->notice.empty()) notify(app, done->notice, ImGui::GetTime());
    }
    news.visible |= follow_comparison(app, engine);
    const bool channel =
        app.display.channel == Channel::albedo || app.display.channel == Channel::normal ||
        app.display.channel == Channel::depth || app.display.channel == Channel::object;
    engine.live.request_channels(channel);
    engine.live.observe_strategies(strategy_request(app));
    return news;
}

RenderSettings job_settings(const RenderChoices& choices) {
    RenderSettings s = choices.settings;
    s.exponents = {choices.exponent};
    if (choices.same_paths) {
        s.exponents = {0, 1, 2};
        for (const double b : {choices.free_exponent, choices.exponent})
            if (std::find(s.exponents.begin(), s.exponents.end(), b) == s.exponents.end() &&
                s.exponents.size() < max_exponents)
                s.exponents.push_back(b);
    }
    return s;
}

void restart_render(App& app, Engine& engine, Engine::Clock::time_point edited) {
    const RenderChoices& r = app.render;
    LiveJob job;
    job.scene = app.document.prepared->scene;
    job.camera = app.document.prepared->camera;
    job.settings = job_settings(r);
    job.threads = r.threads;
    job.stop_passes = r.limits.spp;
    job.stop_seconds = r.limits.seconds;
    engine.live.pause(r.paused);
    const std::uint64_t number = engine.live.submit(job);
    engine.jobs.push_back({number, app.document.prepared, job.settings, edited});
    if (engine.jobs.size() > kept_jobs) engine.jobs.pop_front();
    // Images that are no longer on the screen need no scene: with many lamps each one is large.
    for (SubmittedJob& old : engine.jobs)
        if (app.snapshot && old.number < app.snapshot->job) old.prepared.reset();
    engine.applied = r;
}

void apply(App& app, Engine& engine, const Change& change, Engine::Clock::time_point edited) {
    Document& d = app.document;
    if (!d.prepared) return;
    bool restart = false;
    if (change.scene) engine.updater.submit(d.prepared, d.options, edited);
    if (engine.scene_edited) edited = std::min(edited, *std::exchange(engine.scene_edited, {}));
    if (change.camera) restart |= update_camera(d);
    if (change.settings) {
        const RenderChoices &now = app.render, &old = engine.applied;
        if (engine.jobs.empty() || engine.jobs.back().prepared->scene != d.prepared->scene ||
            !same_job(now, old)) {
            restart = true;
        } else {
            if (now.paused != old.paused) engine.live.pause(now.paused);
            if (!(now.limits == old.limits))
                engine.live.set_limits(now.limits.spp, now.limits.seconds);
            engine.applied = now;
        }
    }
    if (!restart) return;
    if (change.settings || engine.coverage_of != d.prepared->scene) update_coverage(app);
    engine.coverage_of = d.prepared->scene;
    restart_render(app, engine, edited);
}

const SubmittedJob* shown_job(const App& app, const Engine& engine) {
    if (!app.snapshot) return nullptr;
    for (const SubmittedJob& job : engine.jobs)
        if (job.number == app.snapshot->job) return &job;
    return nullptr;
}

void open_document(App& app, Engine& engine, const std::string& name) {
    // The copied command line shall work from any folder, and name the file as the image does.
    const std::string path = std::filesystem::absolute(name).lexically_normal().string();
    // Wishes made before the first file was open are for that file.
    SceneOptions options = app.document.prepared ? SceneOptions{} : app.document.options;
    options.path = path;
    try {
        engine.opening.reset();
        if (is_session_path(path)) {
            LoadedSession loaded = read_session(path);
            options = loaded.session.scene;
            engine.opening = std::move(loaded.session);
        }
    } catch (const std::exception& e) {
        app.document.error = e.what();
        return;
    }
    engine.opening_path = path;
    engine.reloading = false;
    engine.loader.load(options);
}

void reload_document(App& app, Engine& engine) {
    if (!app.document.prepared) return;
    engine.opening.reset();
    engine.opening_path = app.document.path;
    engine.reloading = true;
    engine.loader.load(app.document.options);
}

void watch_files(App& app, Engine& engine) {
    const auto now = Engine::Clock::now();
    if (app.document.files.empty() || !app.document.loading.empty() ||
        now - engine.looked < std::chrono::seconds(1))
        return;
    engine.looked = now;
    const std::uint64_t stamp = file_stamp(app.document.files);
    if (stamp == app.document.stamp) return;
    app.document.stamp = stamp;
    reload_document(app, engine);
}

}  // namespace midway
