// JSON as text for files and people. Names come from files and folders of any bytes: what is not
// UTF-8 is replaced, where nlohmann's own default throws.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace midway {

// indent -1: one line.
inline std::string json_text(const nlohmann::ordered_json& j, int indent = 2) {
    return j.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace midway
