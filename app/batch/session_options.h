// A session in the place of a scene: its choices stand wherever the command line makes none.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "render/session.h"

namespace midway {

// Reads the session that `scene.path` names and fills in its wishes about the scene; empty where
// the path names no session. Warnings are printed unless `quiet`. Throws as read_session.
std::optional<Session> take_session(const CLI::App& command, SceneOptions& scene, bool quiet);

// The same for the settings, parsed already.
void take_settings(const CLI::App& command, const RenderSettings& session,
                   RenderSettings& settings);

}  // namespace midway
