#pragma once
// What a Linux process needs so that a cycle is not late: a real-time priority, a processor of its
// own, memory that is never paged, a processor that does not sleep deeply.

#include <optional>
#include <string>

namespace volcomp::posix {

struct RealTime {
  int priority = 0;  // of SCHED_FIFO, 1…99; 0: as any process
  int cpu = -1;      // the processor to stay on, from 0; -1: any
};

// Locks the memory where a priority is asked for. What failed, as a sentence with what is missing:
// a capability, a limit, a processor. Nothing: all is as asked.
[[nodiscard]] std::optional<std::string> become_real_time(const RealTime& wanted);

}  // namespace volcomp::posix
