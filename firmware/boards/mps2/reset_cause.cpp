#include "firmware/boards/mps2/reset_cause.hpp"

#include "hal/mps2/registers.hpp"

extern "C" {
// Made by the linker script: its address is meant.
extern volatile std::uint32_t retained_begin;
}

namespace volcomp::boards {
namespace {

// After power on RAM holds anything; this is unlikely enough.
constexpr std::uint32_t kWatchdogMark = 0xB17E'D06E;

}  // namespace

ResetCause take_reset_cause() {
  const bool bitten = retained_begin == kWatchdogMark;
  retained_begin = 0;
  return bitten ? ResetCause::watchdog : ResetCause::power_on;
}

void restart(ResetCause cause) {
  constexpr std::uint32_t kApplicationInterruptControl = 0xE000'ED0C;
  constexpr std::uint32_t kKey = 0x05FAU << 16U;
  constexpr std::uint32_t kSystemResetRequest = 1U << 2U;
  retained_begin = cause == ResetCause::watchdog ? kWatchdogMark : 0U;
  __asm volatile("dsb" ::: "memory");
  hal::mps2::device_register(kApplicationInterruptControl) = kKey | kSystemResetRequest;
  for (;;) {
  }
}

}  // namespace volcomp::boards
