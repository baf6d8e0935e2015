#pragma once
// Time and tick from the virtual counter and timer of the processor (Arm Generic Timer, DDI 0487,
// D11): the counter runs from reset at a fixed rate, also while the processor sleeps.

#include <cstdint>

#include "hal/virt/gic.hpp"

namespace volcomp::hal::virt {

inline std::uint64_t counter() {
  std::uint64_t ticks = 0;
  __asm volatile("isb\n mrs %0, cntvct_el0" : "=r"(ticks) : : "memory");
  return ticks;
}

inline std::uint64_t counter_Hz() {
  std::uint64_t rate = 0;
  __asm volatile("mrs %0, cntfrq_el0" : "=r"(rate));
  return rate;
}

// The clock of hal/clock.hpp. Safe in every context.
class Clock {
 public:
  // Not static, so that it is called like every other clock.
  // NOLINTNEXTLINE(readability-convert-member-functions-to-static)
  [[nodiscard]] std::uint64_t now_us() const {
    constexpr std::uint64_t kMicro = 1'000'000;
    const std::uint64_t ticks = counter();
    const std::uint64_t rate = counter_Hz();
    return ticks / rate * kMicro + ticks % rate * kMicro / rate;
  }
};

// Interrupt kVirtualTimerInterrupt: periodic without drift, and once more at an alarm in between.
class PeriodicTimer {
 public:
  void start(std::uint32_t period_us) {
    period_ = counter_Hz() * period_us / 1'000'000U;
    due_ = counter() + period_;
    wake_at(due_);
    __asm volatile("msr cntv_ctl_el0, %0" : : "r"(std::uint64_t{1}));
    gic::enable(kVirtualTimerInterrupt);
  }

  // In the handler, before gic::finish(). False: no period is over, the alarm went off. Periods
  // that have passed meanwhile are left out.
  bool acknowledge() {
    const std::uint64_t now = counter();
    const bool period_is_over = now >= due_;
    if (period_is_over) {
      const std::uint64_t late = now - due_;
      missed_ += static_cast<std::uint32_t>(late / period_);
      due_ += (late / period_ + 1U) * period_;
    }
    wake_at(due_);
    return period_is_over;
  }

  // A time of Clock; it goes off once, unless the next period comes first. UINT64_MAX: none. With
  // this interrupt kept out, after acknowledge().
  void set_alarm(std::uint64_t at_us) const {
    constexpr std::uint64_t kMicro = 1'000'000;
    const std::uint64_t rate = counter_Hz();
    const std::uint64_t at =
        at_us == UINT64_MAX ? due_ : at_us / kMicro * rate + (at_us % kMicro + 1U) * rate / kMicro;
    wake_at(at < due_ ? at : due_);
  }

  // Periods left out so far; wraps around.
  [[nodiscard]] std::uint32_t missed() const { return missed_; }

 private:
  static void wake_at(std::uint64_t count) {
    __asm volatile("msr cntv_cval_el0, %0\n isb" : : "r"(count));
  }

  std::uint64_t period_ = 0;
  std::uint64_t due_ = 0;
  std::uint32_t missed_ = 0;
};

}  // namespace volcomp::hal::virt
