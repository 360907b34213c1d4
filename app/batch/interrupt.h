// Ctrl-C asks a command to end where it can leave whole results behind; a second one ends the
// program at once.
#pragma once

namespace midway {

void catch_interrupt();
bool interrupted();

}  // namespace midway
