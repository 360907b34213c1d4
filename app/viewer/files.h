// What the window does with files when it is asked to (ActionKind), and what it remembers.
#pragma once

#include "engine.h"

namespace midway {

// Files that appear are written beside the window; a line is shown once they are there.
void perform(App& app, Engine& engine, const Action& action);

// Saves what waited for the first whole pass.
void save_waiting(App& app, Engine& engine);

// The line that makes what is shown now from a shell, to the bit. Where lights or materials were
// edited it names a session, which is written into the working folder. Throws where it cannot be.
std::string command_line_of(const App& app, const Engine& engine);

// What a file dropped on the window means, by its name.
Action action_of_drop(const std::string& path);

// The list of recent files, newest first.
void remember_file(App& app, const std::string& path);

}  // namespace midway
