// The path inspector in scripts.
#pragma once

#include <string>
#include <vector>

#include "engine.h"

namespace midway {

// The words after `inspect`. Throws std::invalid_argument.
void inspect_by_script(const std::vector<std::string>& words, App& app);

// Whether the inspector has answered what was asked, lines included.
bool inspected(const App& app, const Engine& engine);

}  // namespace midway
