#include "firmware/boards/virt-a53/reset_cause.hpp"

#include "hal/virt/interrupt_lock.hpp"

// The exception level the processor started in, from start.S: 4 for EL1, 8 for EL2.
extern "C" std::uint64_t first_level;
std::uint64_t first_level = 0;

namespace volcomp::boards {
namespace {

using hal::ResetCause;

// After power on RAM holds anything; these 29 bits are unlikely enough.
constexpr std::uint32_t kMark = 0xB17E'D068;
constexpr std::uint32_t kCause = 0x7;

[[gnu::section(".retained")]] volatile std::uint32_t note;

}  // namespace

// Out of the cache at once: a restart may forget that.
void note_reset_cause(ResetCause cause) {
  note = kMark | static_cast<std::uint32_t>(cause);
  __asm volatile("dc cvac, %0\n dsb sy" : : "r"(&note) : "memory");
}

ResetCause take_reset_cause() {
  const std::uint32_t noted = note;
  note = 0;
  const std::uint32_t cause = noted & kCause;
  const bool valid =
      (noted & ~kCause) == kMark && cause <= static_cast<std::uint32_t>(ResetCause::fault);
  return valid ? static_cast<ResetCause>(cause) : ResetCause::power_on;
}

// The emulator answers at the level above the one it started the program in.
void restart() {
  constexpr std::uint64_t kEl2 = 8;
  constexpr std::uint32_t kSystemReset = 0x8400'0009;
  if (first_level == kEl2) {
    __asm volatile("mov w0, %w0\n smc #0" : : "r"(kSystemReset) : "x0", "memory");
  } else {
    __asm volatile("mov w0, %w0\n hvc #0" : : "r"(kSystemReset) : "x0", "memory");
  }
  for (;;)
    hal::virt::wait_for_interrupt();
}

}  // namespace volcomp::boards
