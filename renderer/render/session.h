// Sessions, `.midway` files: a scene's file with everything that a person changed about it and
// chose for its render, as JSON. Paths stand relative to the session's folder where they can.
// Numbers come back to the bit. Reading throws std::runtime_error with one line for what is broken;
// fields that are not known are left out with a warning, a newer version is refused.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/prepare.h"
#include "render/settings.h"

namespace midway {

struct RenderLimits {
    std::optional<std::uint64_t> spp;  // samples per pixel
    std::optional<double> seconds;
    bool operator==(const RenderLimits&) const = default;
};

struct Session {
    SceneOptions scene;
    RenderSettings settings;
    RenderLimits limits;
    // The window's own words (exposure, curve, ...), kept as they are; no render depends on them.
    std::map<std::string, std::string> window;
};

struct LoadedSession {
    Session session;
    std::vector<std::string> warnings;
};

bool is_session_path(std::string_view path);  // by its name

LoadedSession read_session(const std::string& path);
void write_session(const std::string& path, const Session& session);

}  // namespace midway
