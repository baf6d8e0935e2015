#pragma once
// The watchdog of hal/watchdog.hpp: CMSDK APB watchdog (Arm DDI 0479, 4.4). When the time is over
// it raises the NMI, whose handler stores the cause and requests a system reset; where not even
// that works the hardware resets by itself after the same time again.

#include <cstdint>

#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2 {

class Watchdog {
 public:
  // Not static, so that they are called like those of any other watchdog.
  // NOLINTBEGIN(readability-convert-member-functions-to-static)

  // time_us: 1…171 000 000 between two feeds at most.
  void start(std::uint32_t time_us) {
    device_register(kLock) = kUnlock;
    device_register(kLoad) = time_us * kClock_MHz;
    device_register(kControl) = kInterruptEnable | kResetEnable;
    device_register(kLock) = kLocked;
  }

  void feed() {
    device_register(kLock) = kUnlock;
    device_register(kInterruptClear) = 1;  // counts from the load value again
    device_register(kLock) = kLocked;
  }

  [[nodiscard]] std::uint32_t remaining_us() const { return device_register(kValue) / kClock_MHz; }

  // NOLINTEND(readability-convert-member-functions-to-static)

 private:
  static constexpr std::uint32_t kLoad = kWatchdog + 0x000;
  static constexpr std::uint32_t kValue = kWatchdog + 0x004;
  static constexpr std::uint32_t kControl = kWatchdog + 0x008;
  static constexpr std::uint32_t kInterruptClear = kWatchdog + 0x00C;
  static constexpr std::uint32_t kLock = kWatchdog + 0xC00;
  static constexpr std::uint32_t kInterruptEnable = 1U << 0U;
  static constexpr std::uint32_t kResetEnable = 1U << 1U;
  static constexpr std::uint32_t kUnlock = 0x1ACC'E551;
  static constexpr std::uint32_t kLocked = 0;
};

}  // namespace volcomp::hal::mps2
