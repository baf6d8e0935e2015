#pragma once
// The watchdog of hal/watchdog.hpp. The machine has none: the processor's second timer stands in as
// a fast interrupt, which the masks of interrupts and critical sections leave through. So it bites
// whatever the program does, but not when the processor itself is dead.

#include <cstdint>

#include "hal/virt/generic_timer.hpp"
#include "hal/virt/gic.hpp"

namespace volcomp::hal::virt {

class Watchdog {
 public:
  // At least 1 µs between two feeds. From then on start.S reports the bite and restarts.
  void start(std::uint32_t time_us) {
    time_ = counter_Hz() * time_us / 1'000'000U;
    feed();
    gic::enable_fast(kPhysicalTimerInterrupt);
    __asm volatile("msr cntp_ctl_el0, %0\n isb\n msr daifclr, #1" : : "r"(std::uint64_t{1}));
  }

  void feed() const { __asm volatile("msr cntp_cval_el0, %0\n isb" : : "r"(counter() + time_)); }

  // Not static, so that it is called like that of any other watchdog.
  // NOLINTNEXTLINE(readability-convert-member-functions-to-static)
  [[nodiscard]] std::uint32_t remaining_us() const {
    std::uint32_t ticks = 0;  // signed view of the compare value minus the counter
    __asm volatile("isb\n mrs %x0, cntp_tval_el0" : "=r"(ticks));
    return static_cast<std::uint32_t>(std::uint64_t{ticks} * 1'000'000U / counter_Hz());
  }

 private:
  std::uint64_t time_ = 0;
};

}  // namespace volcomp::hal::virt
