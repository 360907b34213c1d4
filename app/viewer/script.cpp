#include "script.h"

#include <fmt/format.h>
#include <imgui.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "edits.h"
#include "files.h"
#include "image/file.h"
#include "script_input.h"
#include "script_inspect.h"
#include "script_set.h"
#include "strategy_view.h"

namespace midway {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& path, int line,
                       const std::string& remedy) {
    throw std::runtime_error(fmt::format("{} ({}:{}); {}", what, path, line, remedy));
}

struct Verb {
    const char* name;
    size_t least, most;  // words after it
};
constexpr Verb verbs[] = {
    {"open", 1, 1},       {"set", 2, 2},       {"camera", 2, 3},       {"key", 1, 1},
    {"type", 1, 1},       {"move", 2, 2},      {"click", 2, 3},        {"drag", 4, 5},
    {"scroll", 3, 3},     {"drop", 1, 1},      {"resize", 1, 1},       {"wait", 1, 2},
    {"screenshot", 1, 1}, {"save", 1, 1},      {"save-session", 1, 1}, {"copy", 1, 1},
    {"report", 1, 1},     {"mark", 0, 0},      {"reload", 0, 0},       {"timeout", 1, 1},
    {"quit", 0, 0},       {"inspect", 1, 2},   {"hands", 1, 1},        {"keep", 0, 1},
    {"reference", 1, 1},  {"save-plot", 1, 1}, {"edit", 3, 4},         {"select", 2, 2},
    {"undo", 0, 0},       {"redo", 0, 0},      {"reset", 0, 0}};

std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream in(line);
    while (in >> std::ws && in.peek() != '#' && in.peek() != EOF) {
        std::string word;
        if (in.peek() == '"')
            in >> std::quoted(word);
        else
            in >> word;
        words.push_back(word);
    }
    return words;
}

double number(const std::string& text) {
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size())
        throw std::invalid_argument("not a number: \"" + text + "\"");
    return x;
}

double seconds_waited(const ScriptPlayer& p) {
    return std::chrono::duration<double>(ScriptPlayer::Clock::now() - *p.waiting_since).count();
}

bool newest_shown(const App& app, const Engine& engine) {
    return app.snapshot && !engine.jobs.empty() && app.snapshot->job == engine.jobs.back().number &&
           (!app.snapshot->images.empty() || !app.snapshot->error.empty());
}

bool loaded(const App& app, const Engine& engine) {
    return app.document.loading.empty() && !engine.loader.status().busy && !engine.updater.busy();
}

bool strategies_shown(const App& app, double passes) {
    const auto& s = app.snapshot->strategies;
    const PyramidChoices& p = app.display.pyramid;
    return s && app.snapshot->scale == 1 && double(s->passes) >= passes &&
           s->selected == p.selected && (p.selected.empty() || strategies_at_full_size(app));
}

// Whether what a line waits for has come.
bool has_come(const ScriptPlayer& p, const std::vector<std::string>& w, const App& app,
              const Engine& engine) {
    const std::string& what = w[1];
    const auto argument = [&] {
        if (w.size() < 3) throw std::invalid_argument("wait " + what + " needs a number");
        return number(w[2]);
    };
    if (what == "seconds") return seconds_waited(p) >= argument();
    if (what == "frames") return p.waiting_frames >= argument();
    if (what == "file") return w.size() > 2 && std::filesystem::exists(w[2]);
    if (what == "reload") return app.document.prepared != p.scene_then;
    if (what == "loaded") return p.waiting_frames >= 2 && loaded(app, engine);
    if (what == "saved") return engine.save_later.empty() && !engine.tasks.busy();
    // What was just asked for reaches the renderer at the end of the frame.
    if (p.waiting_frames < 2 || !loaded(app, engine)) return false;
    if (what == "image") return newest_shown(app, engine);
    if (what == "measured")
        return newest_shown(app, engine) && !engine.tasks.busy() && is_measured(app, engine);
    if (what == "spp")
        return newest_shown(app, engine) && app.snapshot->scale == 1 &&
               double(app.snapshot->passes) >= argument();
    if (what == "strategies") return newest_shown(app, engine) && strategies_shown(app, argument());
    if (what == "idle")
        return !engine.tasks.busy() &&
               (engine.jobs.empty() ||
                (newest_shown(app, engine) && app.snapshot->scale == 1 &&
                 (app.snapshot->finished || app.snapshot->paused || !app.snapshot->error.empty())));
    if (what == "inspected") return newest_shown(app, engine) && inspected(app, engine);
    throw std::invalid_argument("cannot wait for \"" + what + "\"");
}

// True once the wait is over.
bool wait(ScriptPlayer& p, const std::vector<std::string>& w, const App& app,
          const Engine& engine) {
    if (!p.waiting_since) {
        p.waiting_since = ScriptPlayer::Clock::now();
        p.waiting_frames = 0;
        p.scene_then = app.document.prepared;
    }
    const bool over = has_come(p, w, app, engine);
    ++p.waiting_frames;
    if (over) {
        p.waiting_since.reset();
        p.scene_then.reset();
        return true;
    }
    if (seconds_waited(p) > p.timeout + (w[1] == "seconds" ? number(w[2]) : 0))
        throw std::runtime_error("waited too long for " + w[1] +
                                 (app.document.error.empty() ? "" : ": " + app.document.error));
    return false;
}

// Turns or moves the camera as a hand would, in degrees.
Change move_camera(const std::vector<std::string>& w, App& app) {
    Document& d = app.document;
    if (!d.prepared) throw std::runtime_error("no scene is open");
    const View now = view_in(d.options, d.prepared->camera, app.camera.pivot);
    const double x = number(w[2]), y = w.size() > 3 ? number(w[3]) : 0;
    const Viewport port{180, 180};  // a drag over its height is half a turn
    View next;
    if (w[1] == "orbit")
        next = orbit(now, app.camera.pivot, {x, y}, port);
    else if (w[1] == "look")
        next = look_around(now, dvec2(x, y) * (pi / now.yfov), port);
    else if (w[1] == "dolly")
        next = dolly(now, app.camera.pivot, x, scene_radius(*d.prepared->scene));
    else
        throw std::invalid_argument("the camera cannot \"" + w[1] + "\"");
    use_view(next, d.prepared->camera, d.options);
    return {.camera = true};
}

void resize(const std::string& text, const Host& host) {
    ivec2 size(0);
    int n = 0;
    if (std::sscanf(text.c_str(), "%dx%d%n", &size.x, &size.y, &n) != 2 ||
        static_cast<size_t>(n) != text.size() || size.x < 64 || size.y < 64 || size.x > 16384 ||
        size.y > 16384)
        throw std::invalid_argument("not a size: \"" + text + "\"");
    host.resize(size);
}

void copy(const std::string& path, App& app, Engine& engine) {
    perform(app, engine, {ActionKind::copy_command_line, {}});
    const char* text = ImGui::GetClipboardText();
    atomic_write(path, std::string(text ? text : "") + "\n");
}

ScriptStep carry_out(ScriptPlayer& p, const std::vector<std::string>& w, App& app, Engine& engine,
                     const Host& host) {
    ScriptStep step;
    const std::string& verb = w[0];
    if (verb == "open")
        ask(app, ActionKind::open, w[1]);
    else if (verb == "reload")
        ask(app, ActionKind::reload);
    else if (verb == "save")
        ask(app, ActionKind::save_image, w[1]);
    else if (verb == "save-session")
        ask(app, ActionKind::save_session, w[1]);
    else if (verb == "drop")
        app.actions.push_back(action_of_drop(w[1]));
    else if (verb == "keep")
        ask(app, ActionKind::keep_image, w.size() > 1 ? w[1] : "");
    else if (verb == "reference")
        ask(app, ActionKind::load_reference, w[1] == "none" ? "" : w[1]);
    else if (verb == "save-plot")
        ask(app, ActionKind::save_plot, w[1]);
    else if (verb == "set")
        step.change = set_value(app, w[1], w[2]);
    else if (verb == "edit")
        step.change = edit_by_name(app, {w.begin() + 1, w.end()});
    else if (verb == "undo")
        step.change = undo_edit(app);
    else if (verb == "redo")
        step.change = redo_edit(app);
    else if (verb == "reset")
        step.change = reset_scene(app);
    else if (verb == "select")
        select_at(app, {float(number(w[1])), float(number(w[2]))});
    else if (verb == "camera")
        step.change = move_camera(w, app);
    else if (verb == "resize")
        resize(w[1], host);
    else if (verb == "inspect")
        inspect_by_script({w.begin() + 1, w.end()}, app);
    else if (verb == "copy")
        copy(w[1], app, engine);
    else if (verb == "screenshot")
        step.screenshot = w[1];
    else if (verb == "report")
        step.report = w[1];
    else if (verb == "mark")
        step.mark = true;
    else if (verb == "timeout")
        p.timeout = number(w[1]);
    else if (verb == "hands")
        p.hands = w[1] != "off";
    else if (verb == "quit")
        step.quit = true;
    else
        add_input(p, w);
    return step;
}

}  // namespace

std::vector<ScriptLine> parse_script(const std::string& text, const std::string& path) {
    std::vector<ScriptLine> lines;
    std::istringstream in(text);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        std::vector<std::string> words = words_of(line);
        if (words.empty()) continue;
        const Verb* verb = nullptr;
        for (const Verb& v : verbs)
            if (words[0] == v.name) verb = &v;
        if (!verb)
            fail("unknown action \"" + one_line(words[0]) + "\"", path, number,
                 "app/viewer/script.h lists them");
        if (words.size() - 1 < verb->least || words.size() - 1 > verb->most)
            fail("wrong number of words after \"" + words[0] + "\"", path, number,
                 "app/viewer/script.h shows each action");
        lines.push_back({number, std::move(words)});
    }
    return lines;
}

std::vector<ScriptLine> read_script(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf()))
        throw std::runtime_error("cannot read script (" + one_line(path) + "); check the name");
    return parse_script(text.str(), path);
}

bool wants_frame(const ScriptPlayer& p, const App& app, const Engine& engine) {
    if (!playing(p)) return false;
    if (!p.input.empty() || !p.waiting_since || p.waiting_frames < 2) return true;
    const std::vector<std::string>& words = p.lines[p.next].words;
    if (words[1] == "frames" || seconds_waited(p) > p.timeout) return true;
    try {
        return has_come(p, words, app, engine);
    } catch (const std::exception&) {
        return true;  // play() says which line it is
    }
}

ScriptStep play(ScriptPlayer& p, App& app, Engine& engine, const Host& host) {
    if (p.next >= p.lines.size() || !p.input.empty()) return {};
    const ScriptLine& line = p.lines[p.next];
    try {
        if (line.words[0] == "wait") {
            if (wait(p, line.words, app, engine)) ++p.next;
            return {};
        }
        ++p.next;
        return carry_out(p, line.words, app, engine, host);
    } catch (const std::exception& e) {
        fail(one_line(e.what()), p.path, line.number, "change this line");
    }
}

}  // namespace midway
