// The line that makes the same bits from a shell: `midway render SCENE -o OUT ...`, with all that
// differs from the defaults, quoted for POSIX shells. Numbers are written so that the program reads
// the same bits back.
#pragma once

#include <string>
#include <vector>

#include "render/session.h"

namespace midway {

// The words, the program's name first; unquoted. Edits of single lights and materials fit on no
// command line: where the scene has some, see session_command_line().
std::vector<std::string> command_words(const SceneOptions& scene, const RenderSettings& settings,
                                       const RenderLimits& limits, const std::string& output);

std::string command_line(const SceneOptions& scene, const RenderSettings& settings,
                         const RenderLimits& limits, const std::string& output);

// The same by way of a session that holds scene and settings.
std::string session_command_line(const std::string& session, const RenderLimits& limits,
                                 const std::string& output);

// What differs from the file in a scene, as a command line's options; single edits apart.
std::string scene_options_line(const SceneOptions& scene);

std::string shell_quoted(const std::string& word);

}  // namespace midway
