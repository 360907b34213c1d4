// Threads that leave the processor to others who want it.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace midway {

// Of the calling thread, for good; where it cannot be had, the thread goes on as it is. A third of
// the share of others: enough to keep a window fluid, and with less a thread that is told to stop
// would learn of it too late on a busy machine.
inline void lower_priority() {
#ifdef __linux__
    constexpr int steps = 5;
    const auto thread = static_cast<id_t>(gettid());
    setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + steps);
#endif
}

}  // namespace midway
