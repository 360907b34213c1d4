// Threads that leave the processor to others who want it.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace midway {

// Of the calling thread, for good; where it cannot be had, the thread goes on as it is.
inline void lower_priority() {
#ifdef __linux__
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
#endif
}

}  // namespace midway
