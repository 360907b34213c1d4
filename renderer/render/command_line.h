// The line that makes the same bits from a shell: `midway render SCENE -o OUT ...`, with all that
// differs from the defaults, quoted for POSIX shells. Numbers are written so that the program reads
// the same bits back.
#pragma once

#include <string>
#include <vector>

#include "render/session.h"

namespace midway {

// The words, the program's name first; unquoted.
std::vector<std::string> command_words(const SceneOptions& scene, const RenderSettings& settings,
                                       const RenderLimits& limits, const std::string& output);

std::string command_line(const SceneOptions& scene, const RenderSettings& settings,
                         const RenderLimits& limits, const std::string& output);

std::string shell_quoted(const std::string& word);

}  // namespace midway
