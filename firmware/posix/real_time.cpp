#include "firmware/posix/real_time.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

namespace volcomp::posix {
namespace {

// Deeper than the node ever goes: touched once, the pages are there.
constexpr std::size_t kStackBytes = std::size_t{256} * 1024;

std::string failure(const std::string& what, const char* missing) {
  const int error = errno;
  std::string sentence = what + ": " + std::strerror(error);
  if (error == EPERM || error == ENOMEM) sentence += std::string("; ") + missing;
  return sentence;
}

[[gnu::noinline]] void touch_stack() {
  constexpr std::size_t kPage = 4096;
  std::array<std::uint8_t, kStackBytes> stack{};
  volatile std::uint8_t* const bytes = stack.data();
  for (std::size_t at = 0; at < kStackBytes; at += kPage)
    bytes[at] = 0;
}

std::optional<std::string> lock_memory() {
  // The heap grows while the program starts and is not given back.
  static_cast<void>(::mallopt(M_TRIM_THRESHOLD, -1));
  static_cast<void>(::mallopt(M_MMAP_MAX, 0));
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    return failure("the memory cannot be locked", "CAP_IPC_LOCK or a memlock limit is missing");
  touch_stack();
  return std::nullopt;
}

// Deep sleep of a processor costs up to a millisecond at the next frame. Held open until the
// process ends; where there is none (no such file, no right) the wake-up is as it is.
void keep_processors_awake() {
  const int latency = ::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  constexpr std::int32_t kNone_us = 0;
  if (latency >= 0) static_cast<void>(::write(latency, &kNone_us, sizeof kNone_us));
}

std::optional<std::string> stay_on(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(cpu), &set);
  if (::sched_setaffinity(0, sizeof set, &set) == 0) return std::nullopt;
  if (errno == EINVAL) return "--cpu " + std::to_string(cpu) + ": there is no such processor";
  return failure("--cpu " + std::to_string(cpu), "CAP_SYS_NICE is missing");
}

}  // namespace

std::optional<std::string> become_real_time(const RealTime& wanted) {
  if (wanted.cpu >= 0) {
    if (auto failed = stay_on(wanted.cpu)) return failed;
  }
  if (wanted.priority == 0) {
    // Timers of an ordinary process may be 50 us late to save wake-ups.
    static_cast<void>(::prctl(PR_SET_TIMERSLACK, 1UL));
    return std::nullopt;
  }
  if (auto failed = lock_memory()) return failed;
  keep_processors_awake();
  sched_param parameters{};
  parameters.sched_priority = wanted.priority;
  if (::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) return std::nullopt;
  return failure("--priority " + std::to_string(wanted.priority),
                 "CAP_SYS_NICE or an rtprio limit is missing");
}

}  // namespace volcomp::posix
