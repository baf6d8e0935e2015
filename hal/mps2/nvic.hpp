#pragma once
// Interrupts and their masking (Armv7-M Architecture Reference Manual DDI 0403, B3.4).
//
// Lower number, more urgent. The link may interrupt the tick, so that no byte is lost while it
// runs; the watchdog's NMI and faults interrupt everything.

#include <cstdint>

#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2::nvic {

// Upper three bits only: what every Cortex-M has.
inline constexpr std::uint32_t kLinkPriority = 0x20;
inline constexpr std::uint32_t kTickPriority = 0x40;

inline void enable(std::uint32_t irq, std::uint32_t priority) {
  constexpr std::uint32_t kSetEnable = 0xE000'E100;
  constexpr std::uint32_t kPriority = 0xE000'E400;
  constexpr std::uint32_t kByteMask = 0xFF;
  const std::uint32_t shift = 8U * (irq % 4U);
  volatile std::uint32_t& priorities = device_register(kPriority + 4U * (irq / 4U));
  priorities = (priorities & ~(kByteMask << shift)) | (priority << shift);
  device_register(kSetEnable + 4U * (irq / 32U)) = 1U << (irq % 32U);
}

// As if the device had raised it.
inline void request(std::uint32_t irq) {
  constexpr std::uint32_t kSetPending = 0xE000'E200;
  device_register(kSetPending + 4U * (irq / 32U)) = 1U << (irq % 32U);
}

// Not in QEMU with -icount: it advances the clock there by twice the time that was left, so that
// the next tick comes a period late. Spinning costs the emulator little.
inline void wait_for_interrupt() { __asm volatile("wfi" ::: "memory"); }

}  // namespace volcomp::hal::mps2::nvic
