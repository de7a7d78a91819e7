// On Linux a priority is the thread's own, whatever POSIX says of processes.
#pragma once

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace vsgraphs {

// The calling thread gives way to others of the process: tracking is what a user waits for. `niceness` as of nice(1).
inline void give_way(int niceness) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), niceness);
}

}  // namespace vsgraphs
