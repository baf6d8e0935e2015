#pragma once
// The clock of hal/clock.hpp: first counter of the CMSDK dual timer (Arm DDI 0479, 4.2), running
// freely at 25 MHz and widened to 64 bits.

#include <cstdint>

namespace volcomp::hal::mps2 {

class Clock {
 public:
  // Once; time begins at 0.
  static void start();

  // Has to be called at least once in 171 s, or a turn of the counter is missed. Not reentrant:
  // the background masks the tick.
  [[nodiscard]] std::uint64_t now_us() const;

 private:
  // Extend 32 bits to 64: not visible to a reader.
  mutable std::uint64_t us_ = 0;
  mutable std::uint32_t last_ = 0;      // counter at the last call
  mutable std::uint32_t fraction_ = 0;  // ticks that did not make a whole microsecond yet, 0…24
};

// The counter itself, 40 ns, counting up, wraps in 171 s.
[[nodiscard]] std::uint32_t clock_ticks();

}  // namespace volcomp::hal::mps2
