#include "hal/mps2/watchdog.hpp"

#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2 {
namespace {

constexpr std::uint32_t kLoad = kWatchdog + 0x000;
constexpr std::uint32_t kValue = kWatchdog + 0x004;
constexpr std::uint32_t kControl = kWatchdog + 0x008;
constexpr std::uint32_t kInterruptClear = kWatchdog + 0x00C;
constexpr std::uint32_t kLock = kWatchdog + 0xC00;

constexpr std::uint32_t kInterruptEnable = 1U << 0U;
constexpr std::uint32_t kResetEnable = 1U << 1U;
constexpr std::uint32_t kUnlock = 0x1ACC'E551;
constexpr std::uint32_t kLocked = 0;

}  // namespace

void Watchdog::start(std::uint32_t time_us) {
  device_register(kLock) = kUnlock;
  device_register(kLoad) = time_us * kClock_MHz;
  device_register(kControl) = kInterruptEnable | kResetEnable;
  device_register(kLock) = kLocked;
}

void Watchdog::feed() {
  device_register(kLock) = kUnlock;
  device_register(kInterruptClear) = 1;  // counts from the load value again
  device_register(kLock) = kLocked;
}

std::uint32_t Watchdog::remaining_us() const { return device_register(kValue) / kClock_MHz; }

}  // namespace volcomp::hal::mps2
