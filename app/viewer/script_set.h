// Values by name: what scripts set, what a session remembers of the window, and what the command
// line of midway-view takes as --KEY VALUE. Names and values of light transport are those of
// `midway render`.
#pragma once

#include <map>
#include <string>

#include "state.h"

namespace midway {

// Throws std::invalid_argument with one line for an unknown key or a value that makes no sense.
Change set_value(App& app, const std::string& key, const std::string& value);

bool is_value_key(const std::string& key);

// How the image is shown, and the views to come back to, as set_value() takes them.
std::map<std::string, std::string> window_values(const App& app);

}  // namespace midway
