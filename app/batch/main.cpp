// midway: the renderer without a window.
#include <fmt/format.h>

#include <exception>
#include <map>
#include <new>
#include <stdexcept>

#include "commands.h"

namespace {

int fail(const std::string& message) {
    fmt::print(stderr, "midway: error: {}\n", message);
    return midway::exit_failed;
}

// Wrong usage is one line too, with the way to the help.
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::string what = error.what();
    for (char& c : what)
        if (c == '\n') c = ' ';
    fmt::print(stderr, "midway: error: {} (command line); see midway --help\n", what);
    return midway::exit_usage;
}

// The command line as a shell would read it again.
std::string typed_command(int argc, char** argv) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+./,:@%";
    std::string text = "midway";
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        text += ' ';
        if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) {
            text += word;
            continue;
        }
        text += '\'';
        for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
        text += '\'';
    }
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Midway: a bidirectional path tracer for glTF scenes", "midway");
    app.require_subcommand(1);
    app.set_version_flag("--version", std::string("midway ") + MIDWAY_VERSION);
    const std::map<std::string, midway::Command> commands = {
        {"render", midway::add_render_command(app)},
        {"info", midway::add_info_command(app)},
        {"diff", midway::add_diff_command(app)},
        {"compare", midway::add_compare_command(app, typed_command(argc, argv))},
        {"merge", midway::add_merge_command(app)},
        {"check", midway::add_check_command(app)},
        {"bench", midway::add_bench_command(app)},
        {"view", midway::add_view_command(app)}};
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return report_usage(app, error);
    }
    try {
        return commands.at(app.get_subcommands().front()->get_name())();
    } catch (const CLI::ParseError& error) {
        return report_usage(app, error);
    } catch (const std::invalid_argument& error) {
        fail(error.what());
        return midway::exit_usage;
    } catch (const std::bad_alloc&) {
        return fail("out of memory (scene or image); use a smaller one");
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}
