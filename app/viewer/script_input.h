// Mouse and keyboard of a script: an action becomes the steps of some frames.
#pragma once

#include "script.h"

namespace midway {

// The actions key, type, move, click, drag and scroll; throws std::invalid_argument with a few
// words.
void add_input(ScriptPlayer& player, const std::vector<std::string>& words);

}  // namespace midway
