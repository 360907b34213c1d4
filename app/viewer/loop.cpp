#include "loop.h"

#include <imgui.h>

#include <filesystem>

#include "display_values.h"
#include "files.h"
#include "image/png.h"
#include "panels/panels.h"
#include "plot_drawing.h"
#include "theme.h"

namespace midway {
namespace {

using Clock = Engine::Clock;

constexpr double animation_seconds = 1.0 / 60;
constexpr double script_seconds = 1.0 / 20;  // between looks at whether a wait is over
constexpr auto resize_rest = std::chrono::milliseconds(200);
constexpr size_t exposure_pixels = 20000;  // enough for an average, few enough for a frame

double seconds_since(Clock::time_point t) {
    return std::chrono::duration<double>(Clock::now() - t).count();
}

// ImGui's clock, which stands still between frames.
double gui_now(const Loop& l) { return ImGui::GetTime() + seconds_since(l.last_frame); }

// How long the window may sleep; below zero: until something happens.
double rest(const Loop& l) {
    if (l.frames_due > 0) return 0;
    const bool refitting = l.engine.refit && l.app.document.prepared;
    if (l.app.camera.animating || l.frames_left >= 0 || refitting)
        return std::max(0.0, animation_seconds - seconds_since(l.last_frame));
    if (playing(l.script)) return wants_frame(l.script, l.app, l.engine) ? 0 : script_seconds;
    if (l.app.ui.notice_until > 0) return std::clamp(l.app.ui.notice_until - gui_now(l), 0.0, 1.0);
    return l.app.document.files.empty() ? -1 : 1;  // to look at the files' stamp
}

// Follows the window's size, once it rests: never that of the panels.
Change fit_image(Loop& l) {
    if (!l.engine.refit || Clock::now() - l.engine.resized < resize_rest) return {};
    const ivec2 room = l.app.ui.view.size() * l.app.ui.pixels_per_point;
    if (room.x < 16 || room.y < 16) return {};
    l.engine.refit = false;
    RenderSettings& s = l.app.render.settings;
    if (!l.app.render.fit_window || (s.width == room.x && s.height == room.y)) return {};
    s.width = room.x;
    s.height = room.y;
    s.crop.reset();
    return {.settings = true};
}

void watch_size(Loop& l) {
    const Display::Target target = l.host.target();
    l.app.ui.pixels_per_point = target.scale;
    if (target.size == l.size) return;
    // The first size of all needs no rest.
    if (l.size.x > 0) l.engine.resized = Clock::now();
    l.size = target.size;
    l.engine.refit = true;
    l.memory.window = ivec2(vec2(target.size) / target.scale);
    l.frames_due = 3;
}

void follow_exposure(Loop& l) {
    App& app = l.app;
    if (!app.display.auto_exposure || !app.snapshot || app.snapshot == l.shown_snapshot ||
        app.snapshot->images.empty())
        return;
    const Image& all = *app.snapshot->images[shown_exponent(app)];
    const size_t step = std::max<size_t>(1, all.pixels.size() / exposure_pixels) | 1;
    Image some;
    for (size_t i = 0; i < all.pixels.size(); i += step) some.pixels.push_back(all.pixels[i]);
    some.width = static_cast<int>(some.pixels.size());
    some.height = 1;
    app.display.exposure_ev = auto_exposure(some);
}

// Makes and uploads what is shown, where something about it changed.
void update_image(Loop& l) {
    App& app = l.app;
    follow_exposure(l);
    DisplayChoices choices = app.display;
    choices.zoom = 0;
    choices.pan = vec2(0);
    const CompareLook look = compare_look(app);
    if (app.snapshot == l.shown_snapshot && app.channels == l.shown_channels &&
        choices == l.shown_choices && app.render.exponent == l.shown_exponent &&
        look == l.shown_look)
        return;
    l.shown = shown_image(app);
    l.shown_snapshot = app.snapshot;
    l.shown_channels = app.channels;
    l.shown_choices = choices;
    l.shown_exponent = app.render.exponent;
    l.shown_look = look;
    l.display.update(l.shown);
}

// The image of an edit is on the screen now.
void note_latency(Loop& l) {
    if (!l.shown.image) return;
    if (l.app.timings.first_pixels == 0)
        l.app.timings.first_pixels = l.options.seconds_before + seconds_since(l.start);
    for (SubmittedJob& job : l.engine.jobs) {
        if (job.shown || !l.app.snapshot || job.number > l.app.snapshot->job) continue;
        job.shown = true;
        // Jobs that never had an image were replaced while the edit still went on.
        if (job.number != l.app.snapshot->job) continue;
        note_time(l.app.timings.edit_to_image, seconds_since(job.edited));
        const LiveLatency latency = l.engine.live.latency();
        if (latency.stop_seconds > 0) note_time(l.app.timings.stops, latency.stop_seconds);
    }
}

void draw(Loop& l, const std::string& screenshot) {
    const Display::Target target = l.host.target();
    const ImVec4 surround = theme::surround;
    l.display.draw(l.app, target, {surround.x, surround.y, surround.z});
    l.lines.draw(l.app, target);
    l.painter.draw(*ImGui::GetDrawData(), target.size);
    if (!screenshot.empty())
        write_png_bytes(screenshot, target.size.x, target.size.y, read_pixels(*l.host.gl, target));
    l.host.end_frame();
}

void update_title(Loop& l) {
    const std::string file = std::filesystem::path(l.app.document.path).filename().string();
    const std::string title = file.empty() ? "Midway" : file + " - Midway";
    if (title == l.title) return;
    l.title = title;
    l.host.set_title(title);
}

bool is_plot_picture(const Action& action) {
    return action.kind == ActionKind::save_plot && action.text.ends_with(".png");
}

// Painted here, where OpenGL is; written beside the window.
void save_plot_picture(Loop& l, const std::string& path) {
    const ivec2 size(vec2(960, 600) * l.app.ui.scale);
    const Plot plot = make_plot(l.app.compare, l.app.compare.metric);
    l.engine.tasks.submit([path, size, rgb = paint_plot(*l.host.gl, l.painter, plot, size)] {
        write_png_bytes(path, size.x, size.y, rgb);
        return "saved " + path;
    });
}

void act(Loop& l) {
    for (const std::string& path : l.host.dropped()) l.app.actions.push_back(action_of_drop(path));
    const std::vector<Action> actions = std::exchange(l.app.actions, {});
    for (const Action& action : actions) {
        if (action.kind == ActionKind::quit) l.quit = true;
        if (is_plot_picture(action))
            save_plot_picture(l, action.text);
        else
            perform(l.app, l.engine, action);
    }
    if (!actions.empty()) l.frames_due = 3;
    save_waiting(l.app, l.engine);
    watch_files(l.app, l.engine);
}

// The frames that --frames asks for are counted from the first image (or error) on.
bool last_frame(Loop& l) {
    if (!l.options.frames || playing(l.script)) return false;
    const bool ready = l.shown.image || !l.app.document.error.empty();
    if (l.frames_left < 0 && ready) l.frames_left = *l.options.frames;
    return l.frames_left >= 0 && --l.frames_left <= 0;
}

void frame(Loop& l, Change change) {
    const auto began = l.last_frame = Clock::now();
    l.host.begin_frame();
    if (!l.script.lines.empty()) give_input(l.script);
    ImGui::NewFrame();
    l.app.camera.animating = false;
    for (const Panel& panel : panels()) change |= panel.draw(l.app);
    draw_pixel_values(l.app, l.shown);
    change |= fit_image(l);
    apply(l.app, l.engine, change, began);
    const ScriptStep step = play(l.script, l.app, l.engine, l.host);
    apply(l.app, l.engine, step.change, began);
    change |= step.change;
    if (l.app.document.prepared)
        note_wishes(l.app.undo, l.app.document.options, ImGui::IsAnyItemActive());
    act(l);
    follow_inspection(l.app, l.engine);
    if (change.any()) l.frames_due = std::max(l.frames_due, 2);

    update_image(l);
    l.pyramid.update(l.app);
    ImGui::Render();
    const bool last = last_frame(l);
    draw(l, last ? l.options.screenshot : step.screenshot);
    note_latency(l);
    note_time(l.app.timings.frames, seconds_since(began));
    if (step.mark) l.mark = mark_now(l.app);
    if (!step.report.empty()) write_report(step.report, l.app, l.mark);
    if (step.quit || last) l.quit = true;
    update_title(l);
}

}  // namespace

Loop make_loop(App& app, Engine& engine, const Host& host) {
    return {.app = app,
            .engine = engine,
            .host = host,
            .display = Display(*host.gl),
            .lines = LinePainter(*host.gl),
            .painter = PanelPainter(*host.gl),
            .pyramid = PyramidAtlas(*host.gl)};
}

void run(Loop& l) {
    while (!l.quit) {
        l.host.wait(rest(l));
        watch_size(l);
        const News news = collect(l.app, l.engine);
        if (l.host.had_event()) l.frames_due = 3;
        const bool notice_over = l.app.ui.notice_until > 0 && l.app.ui.notice_until < gui_now(l);
        if (notice_over) l.app.ui.notice_until = 0;
        if (news.visible || news.change.any() || notice_over || l.app.camera.animating ||
            l.frames_left >= 0 || wants_frame(l.script, l.app, l.engine))
            l.frames_due = std::max(l.frames_due, 1);
        if (l.host.closing()) l.quit = true;
        // A look at the files needs no frame; neither does resting until the window's size does.
        if (l.frames_due <= 0 && l.engine.refit && l.app.document.prepared &&
            Clock::now() - l.engine.resized >= resize_rest)
            l.frames_due = 1;
        if (l.frames_due <= 0) {
            watch_files(l.app, l.engine);
            continue;
        }
        --l.frames_due;
        frame(l, news.change);
    }
    keep(l.app, l.memory);
}

}  // namespace midway
