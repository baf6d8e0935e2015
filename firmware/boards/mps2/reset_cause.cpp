#include "firmware/boards/mps2/reset_cause.hpp"

#include "firmware/boards/mps2/linker_symbols.hpp"
#include "hal/mps2/registers.hpp"

namespace volcomp::boards {
namespace {

using hal::ResetCause;

// After power on RAM holds anything; these 29 bits are unlikely enough.
constexpr std::uint32_t kMark = 0xB17E'D068;
constexpr std::uint32_t kCause = 0x7;

}  // namespace

void note_reset_cause(ResetCause cause) {
  retained_begin[0] = kMark | static_cast<std::uint32_t>(cause);
}

ResetCause noted_reset_cause() {
  const std::uint32_t note = retained_begin[0];
  const std::uint32_t cause = note & kCause;
  const bool valid =
      (note & ~kCause) == kMark && cause <= static_cast<std::uint32_t>(ResetCause::fault);
  return valid ? static_cast<ResetCause>(cause) : ResetCause::power_on;
}

ResetCause take_reset_cause() {
  const ResetCause cause = noted_reset_cause();
  retained_begin[0] = 0;
  return cause;
}

void restart() {
  constexpr std::uint32_t kApplicationInterruptControl = 0xE000'ED0C;
  constexpr std::uint32_t kKey = 0x05FAU << 16U;
  constexpr std::uint32_t kSystemResetRequest = 1U << 2U;
  __asm volatile("dsb" ::: "memory");  // what was noted has arrived
  hal::mps2::device_register(kApplicationInterruptControl) = kKey | kSystemResetRequest;
  for (;;) {
  }
}

}  // namespace volcomp::boards
