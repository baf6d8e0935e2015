#include "firmware/boards/mps2/reset_cause.hpp"

#include "firmware/boards/mps2/linker_symbols.hpp"
#include "hal/mps2/registers.hpp"

namespace volcomp::boards {
namespace {

// After power on RAM holds anything; this is unlikely enough.
constexpr std::uint32_t kWatchdogMark = 0xB17E'D06E;

}  // namespace

ResetCause take_reset_cause() {
  const bool bitten = retained_begin[0] == kWatchdogMark;
  retained_begin[0] = 0;
  return bitten ? ResetCause::watchdog : ResetCause::power_on;
}

void restart(ResetCause cause) {
  constexpr std::uint32_t kApplicationInterruptControl = 0xE000'ED0C;
  constexpr std::uint32_t kKey = 0x05FAU << 16U;
  constexpr std::uint32_t kSystemResetRequest = 1U << 2U;
  retained_begin[0] = cause == ResetCause::watchdog ? kWatchdogMark : 0U;
  __asm volatile("dsb" ::: "memory");
  hal::mps2::device_register(kApplicationInterruptControl) = kKey | kSystemResetRequest;
  for (;;) {
  }
}

}  // namespace volcomp::boards
