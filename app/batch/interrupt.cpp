#include "interrupt.h"

#include <csignal>

namespace midway {
namespace {

volatile std::sig_atomic_t asked = 0;

}  // namespace

void catch_interrupt() {
    std::signal(SIGINT, [](int) {
        if (asked) std::signal(SIGINT, SIG_DFL);
        asked = 1;
    });
}

bool interrupted() { return asked != 0; }

}  // namespace midway
