#pragma once
// Counts executed instructions with SysTick (Armv7-M, DDI 0403, B3.3), which counts down 24 bits of
// the processor clock.
//
// Right only in QEMU with `-icount shift=6,sleep=off`: there every instruction takes 64 ns and a
// tick is 40 ns, so a count is the same in every run, +-1. The emulator knows neither cycles nor
// caches: these are instructions, never microseconds.
//
//   const InstructionCounter counter;
//   work();
//   const std::uint32_t instructions = counter.elapsed();

#include <cstdint>

#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2 {

class InstructionCounter {
 public:
  // Once, before the first count.
  static void start_hardware() {
    device_register(kReload) = kMask;
    device_register(kValue) = 0;
    device_register(kControl) = kEnable | kProcessorClock;
  }

  InstructionCounter() : begin_(device_register(kValue)) {}

  // Since construction, at most 10 million; includes the few of the counting itself.
  [[nodiscard]] std::uint32_t elapsed() const {
    const std::uint32_t ticks = (begin_ - device_register(kValue)) & kMask;
    return (ticks * 5U + 4U) / 8U;
  }

 private:
  static constexpr std::uint32_t kControl = 0xE000'E010;
  static constexpr std::uint32_t kReload = 0xE000'E014;
  static constexpr std::uint32_t kValue = 0xE000'E018;
  static constexpr std::uint32_t kEnable = 1U << 0U;
  static constexpr std::uint32_t kProcessorClock = 1U << 2U;
  static constexpr std::uint32_t kMask = 0xFF'FFFF;

  std::uint32_t begin_;
};

}  // namespace volcomp::hal::mps2
