// midway-view: the window.
#include <fmt/format.h>
#include <imgui.h>

#include <charconv>
#include <stdexcept>

#include "gallery.h"
#include "loop.h"
#include "offscreen.h"
#include "panels/panels.h"
#include "script_set.h"
#include "window.h"

namespace midway {
namespace {

constexpr const char* usage_text =
    R"(midway-view: explore a scene while it converges

midway-view [SCENE] [--OPTION VALUE ...]     SCENE: .gltf, .glb or .midway; default: the idol
    --window WxH                 size of the window
    --offscreen                  draw in memory, without a display
    --frames N                   end after so many frames with an image
    --screenshot FILE.png        the last of them, panels included
    --script FILE                play a list of actions (app/viewer/script.h)
    --scale X                    of fonts, where there is no monitor to ask
    --gl egl|osmesa              what --offscreen draws with
Options of `midway render` that say what is rendered (--technique, --exponent, --spp, --size,
--look-at, --sky, ...) and those of the display (--exposure, --curve, --channel, ...) work here too.
)";

struct Command {
    std::string scene, script, screenshot;
    std::vector<std::pair<std::string, std::string>> values;
    std::optional<int> frames;
    std::optional<ivec2> window;
    bool offscreen = false;
    float scale = 1;
    OffscreenKind kind = OffscreenKind::automatic;
};

[[noreturn]] void refuse(const std::string& what) {
    throw std::invalid_argument(what + " (command line); see midway-view --help");
}

template <class Number>
Number number(const std::string& option, const std::string& text, Number low, Number high) {
    Number n{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || end != text.data() + text.size() || !(n >= low && n <= high))
        refuse(fmt::format("--{}: \"{}\" is not a number from {} to {}", option, text, low, high));
    return n;
}

ivec2 window_size(const std::string& text) {
    const size_t x = text.find('x');
    if (x == std::string::npos) refuse("--window: \"" + text + "\" is not WxH");
    return {number("window", text.substr(0, x), 64, 16384),
            number("window", text.substr(x + 1), 64, 16384)};
}

void take_option(Command& c, const std::string& name, const std::string& value) {
    if (name == "window")
        c.window = window_size(value);
    else if (name == "frames")
        c.frames = number("frames", value, 1, 1000000);
    else if (name == "screenshot")
        c.screenshot = value;
    else if (name == "script")
        c.script = value;
    else if (name == "scale")
        c.scale = number("scale", value, 0.5f, 8.0f);
    else if (name == "gl" && (value == "egl" || value == "osmesa"))
        c.kind = value == "egl" ? OffscreenKind::egl : OffscreenKind::osmesa;
    else if (is_value_key(name))
        c.values.emplace_back(name, value);
    else
        refuse("unknown option or value (--" + name + " " + value + ")");
}

Command parse(int argc, char** argv) {
    Command c;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--offscreen") {
            c.offscreen = true;
        } else if (word.rfind("--", 0) == 0) {
            const size_t equals = word.find('=');
            if (equals == std::string::npos && i + 1 == argc) refuse(word + " needs a value");
            if (equals == std::string::npos)
                take_option(c, word.substr(2), argv[++i]);
            else
                take_option(c, word.substr(2, equals - 2), word.substr(equals + 1));
        } else if (!c.scene.empty()) {
            refuse("more than one scene (" + word + ")");
        } else {
            c.scene = word;
        }
    }
    if (!c.screenshot.empty() && !c.frames) c.frames = 1;
    return c;
}

// ImGui's context for as long as it is needed.
struct Gui {
    Gui() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().LogFilename = nullptr;
    }
    ~Gui() { ImGui::DestroyContext(); }
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;
};

// Starts loading before the window is there: the one takes as long as the other.
void open_first(App& app, Engine& engine, const Command& c) {
    std::string path = c.scene;
    if (path.empty() && c.script.empty() && !assets_folder().empty())
        path = (assets_folder() / "idol.glb").string();
    if (path.empty()) return;
    open_document(app, engine, path);
}

int run_window(const Command& c, Engine::Clock::time_point start) {
    const Gui gui;
    App app;
    Engine engine;
    std::string reason;
    if (!c.offscreen && !have_display(reason))
        throw std::runtime_error("there is no display (" + reason +
                                 "); use midway-view --offscreen, or midway render");
    ScriptPlayer script;
    if (!c.script.empty()) {
        script.path = c.script;
        script.lines = read_script(c.script);
    }
    for (const auto& [key, value] : c.values) set_value(app, key, value);
    open_first(app, engine, c);

    Memory memory;
    if (!c.offscreen && c.script.empty()) {
        memory = recall(app);
        app.ui.first_visit = !memory.read && c.scene.empty();
    }
    const ivec2 size = c.window.value_or(memory.window);
    const Host host =
        c.offscreen ? make_offscreen(size, c.scale, c.kind) : make_window(size, "Midway");
    app.ui.scale = c.scale != 1 ? c.scale : host.scale;
    apply_theme(app.ui.scale);
    engine.waker.set(host.wake);
    {
        Loop loop = make_loop(app, engine, host);
        loop.script = std::move(script);
        loop.memory = memory;
        loop.options = {c.frames, c.screenshot,
                        std::chrono::duration<double>(Engine::Clock::now() - start).count()};
        run(loop);
    }
    engine.waker.set({});
    return 0;
}

int fail(const std::string& message, int status) {
    fmt::print(stderr, "midway-view: error: {}\n", message);
    return status;
}

}  // namespace
}  // namespace midway

int main(int argc, char** argv) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 1; i < argc; ++i) {
        if (argv[i] == std::string_view("--help") || argv[i] == std::string_view("-h")) {
            fmt::print("{}", midway::usage_text);
            return 0;
        }
        if (argv[i] == std::string_view("--version")) {
            fmt::print("midway-view {}\n", MIDWAY_VERSION);
            return 0;
        }
    }
    try {
        return midway::run_window(midway::parse(argc, argv), start);
    } catch (const std::invalid_argument& error) {
        return midway::fail(error.what(), 2);
    } catch (const std::bad_alloc&) {
        return midway::fail("out of memory (scene or image); use a smaller one", 1);
    } catch (const std::exception& error) {
        return midway::fail(error.what(), 1);
    }
}
