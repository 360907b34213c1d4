// midway view: starts the window, midway-view, which lies beside this program.
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

#include "commands.h"

namespace midway {
namespace {

namespace fs = std::filesystem;

// Becomes midway-view; returns only by throwing.
int become_window(const CLI::App& command) {
    std::error_code ignored;
    const fs::path window =
        fs::read_symlink("/proc/self/exe", ignored).replace_filename("midway-view");
    if (!fs::exists(window, ignored))
        throw std::runtime_error("this build has no window (" + window.string() +
                                 "); build the preset release, or use midway render");
    std::vector<std::string> words = command.remaining();
    words.insert(words.begin(), window.string());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(window.c_str(), arguments.data());
    throw std::runtime_error("the window does not start (" + window.string() +
                             "); check its permissions");
}

}  // namespace

Command add_view_command(CLI::App& app) {
    CLI::App* sub = app.add_subcommand("view", "Open the window, midway-view");
    sub->prefix_command();
    return [sub] { return become_window(*sub); };
}

}  // namespace midway
