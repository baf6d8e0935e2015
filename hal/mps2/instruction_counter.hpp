#pragma once
// Counts executed instructions exactly with SysTick (Armv7-M, Arm DDI 0403, B3.3), in QEMU started
// with `-icount shift=6,sleep=off`: every instruction then takes 64 ns of virtual time, and SysTick
// counts every 40 ns.
//
// After I instructions it has counted T = ⌊(64·I + c) / 40⌋; c is fixed by the moment it was
// started and matters in steps of 8 ns only, its phase 0…4. An instruction is longer than a tick,
// so T gives I as soon as the phase is known, and three of the eight values of T mod 8 never occur:
// which three depends on the phase. A reading that contradicts it proves that QEMU was started in
// another way.
//
// The emulator knows neither cycles nor caches: these are instructions, never microseconds.

#include <cstdint>

namespace volcomp::hal::mps2 {

class InstructionCounter {
 public:
  // Starts SysTick and finds the phase.
  void start();

  // What SysTick has counted; 24 bits, wraps after 10 485 760 instructions. A call, so that every
  // reading costs the same: two in a row give what to subtract.
  [[nodiscard]] static std::uint32_t ticks();

  // Instructions executed between two values of ticks() less than one wrap apart.
  [[nodiscard]] std::uint32_t between(std::uint32_t from, std::uint32_t to);

  // False when some reading cannot have come from counting instructions.
  [[nodiscard]] bool exact() const { return exact_; }

 private:
  // Whether a whole number of instructions leads to this reading.
  [[nodiscard]] static bool fits(std::uint32_t ticks, std::uint32_t phase) {
    return ((phase - 5U * ticks) & 7U) < 5U;
  }
  [[nodiscard]] std::uint32_t instructions(std::uint32_t ticks);

  std::uint32_t phase_ = 0;
  bool exact_ = false;
};

}  // namespace volcomp::hal::mps2
