// The commands of the program `midway`. Each adds its options to the command line and is run after
// parsing; the number it returns is the exit status (README, "Bad input").
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "render/prepare.h"

namespace midway {

enum ExitStatus {
    exit_done = 0,
    exit_failed = 1,
    exit_usage = 2,
    exit_nonfinite = 3,
    exit_checkpointed = 75,
    exit_interrupted = 130
};

using Command = std::function<int()>;

Command add_render_command(CLI::App& app);
Command add_info_command(CLI::App& app);
Command add_diff_command(CLI::App& app);
Command add_merge_command(CLI::App& app);
Command add_check_command(CLI::App& app);
Command add_view_command(CLI::App& app);
Command add_bench_command(CLI::App& app);

// `typed` is the whole command line, for reports that say how to make them again.
Command add_compare_command(CLI::App& app, const std::string& typed);

// Options that choose and change the scene, shared by several commands.
void add_scene_options(CLI::App& command, SceneOptions& options);

// "midway: warning: ..." lines on stderr.
void print_warnings(const std::vector<std::string>& warnings);

}  // namespace midway
