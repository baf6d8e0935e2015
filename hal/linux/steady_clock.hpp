#pragma once
// The clock of hal/clock.hpp on Linux: CLOCK_MONOTONIC, time since some moment before boot.

#include <cstdint>
#include <ctime>

namespace volcomp::hal {

class SteadyClock {
 public:
  // Not static, so that it is called like every other clock.
  // NOLINTNEXTLINE(readability-convert-member-functions-to-static)
  [[nodiscard]] std::uint64_t now_us() const {
    timespec now{};
    static_cast<void>(clock_gettime(CLOCK_MONOTONIC, &now));  // cannot fail with this clock
    return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000U +
           static_cast<std::uint64_t>(now.tv_nsec) / 1'000U;
  }
};

}  // namespace volcomp::hal
