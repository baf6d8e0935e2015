#pragma once
// The watchdog of hal/watchdog.hpp: CMSDK APB watchdog (Arm DDI 0479, 4.4). When the time is over
// it raises the NMI, whose handler notes why and requests a system reset; where not even that works
// the hardware resets by itself after the same time again.

#include <cstdint>

namespace volcomp::hal::mps2 {

class Watchdog {
 public:
  // time_us: 1…171 000 000 between two feeds at most.
  static void start(std::uint32_t time_us);

  // Not static, so that they are called like those of any other watchdog.
  // NOLINTBEGIN(readability-convert-member-functions-to-static)
  void feed();
  [[nodiscard]] std::uint32_t remaining_us() const;
  // NOLINTEND(readability-convert-member-functions-to-static)
};

}  // namespace volcomp::hal::mps2
