#pragma once
// Periodic interrupts and alarms (CMSDK APB timer, Arm DDI 0479, 4.1).

#include <cstdint>

#include "hal/mps2/nvic.hpp"
#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2 {

class Timer {
 public:
  constexpr Timer(std::uint32_t base, std::uint32_t irq) : base_(base), irq_(irq) {}

  // An interrupt every period_us (1…100 000 000) of the tick's priority.
  void start(std::uint32_t period_us) const {
    count_down(period_us);
    enable();
  }

  // First thing in the handler, else it is called again at once.
  void acknowledge() const { device_register(base_ + kInterruptClear) = 1; }

  // As an alarm: enable() once, set_alarm() as often as wanted, in the handler stop() before
  // acknowledge().
  void enable() const { nvic::enable(irq_, nvic::kTickPriority); }
  // An interrupt after_us (1…100 000 000) from now; an alarm that was set before is forgotten.
  void set_alarm(std::uint32_t after_us) const {
    stop();
    count_down(after_us);
  }
  void stop() const { device_register(base_ + kControl) = 0; }
  // As if it had gone off. In any context.
  void raise() const { nvic::request(irq_); }

 private:
  static constexpr std::uint32_t kControl = 0x0;
  static constexpr std::uint32_t kValue = 0x4;
  static constexpr std::uint32_t kReload = 0x8;
  static constexpr std::uint32_t kInterruptClear = 0xC;
  static constexpr std::uint32_t kEnable = 1U << 0U;
  static constexpr std::uint32_t kInterruptEnable = 1U << 3U;

  void count_down(std::uint32_t us) const {
    const std::uint32_t reload = us * kClock_MHz - 1U;
    device_register(base_ + kReload) = reload;
    device_register(base_ + kValue) = reload;
    device_register(base_ + kControl) = kEnable | kInterruptEnable;
  }

  std::uint32_t base_;
  std::uint32_t irq_;
};

inline constexpr Timer timer0{kTimer0, kTimer0Irq};
inline constexpr Timer timer1{kTimer1, kTimer1Irq};

}  // namespace volcomp::hal::mps2
