// Files that appear whole or not at all: the bytes go to a hidden file in the same folder, which is
// then renamed over the target; after a failure the hidden file is gone and an older target is
// untouched. A target that is a link is followed; a device or pipe is written in place. Throws
// std::runtime_error with one line "WHAT (WHERE); REMEDY".
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace midway {

void atomic_write(const std::string& path, std::string_view bytes);

// The same for what is better streamed. An exception thrown by `write` removes the hidden file and
// passes through.
void atomic_write(const std::string& path, const std::function<void(std::ofstream&)>& write);

// The text with line breaks and other control characters as spaces, fit for a one-line message.
std::string one_line(std::string_view text);

}  // namespace midway
