#pragma once
// Periodic interrupts (CMSDK APB timer, Arm DDI 0479, 4.1).

#include <cstdint>

#include "hal/mps2/nvic.hpp"
#include "hal/mps2/registers.hpp"

namespace volcomp::hal::mps2 {

class PeriodicTimer {
 public:
  constexpr PeriodicTimer(std::uint32_t base, std::uint32_t irq) : base_(base), irq_(irq) {}

  // An interrupt every period_us (1…100 000 000) of the tick's priority.
  void start(std::uint32_t period_us) const {
    const std::uint32_t reload = period_us * kClock_MHz - 1U;
    device_register(base_ + kReload) = reload;
    device_register(base_ + kValue) = reload;
    device_register(base_ + kControl) = kEnable | kInterruptEnable;
    nvic::enable(irq_, nvic::kTickPriority);
  }

  // First thing in the handler, else it is called again at once.
  void acknowledge() const { device_register(base_ + kInterruptClear) = 1; }

 private:
  static constexpr std::uint32_t kControl = 0x0;
  static constexpr std::uint32_t kValue = 0x4;
  static constexpr std::uint32_t kReload = 0x8;
  static constexpr std::uint32_t kInterruptClear = 0xC;
  static constexpr std::uint32_t kEnable = 1U << 0U;
  static constexpr std::uint32_t kInterruptEnable = 1U << 3U;

  std::uint32_t base_;
  std::uint32_t irq_;
};

inline constexpr PeriodicTimer timer0{kTimer0, kTimer0Irq};
inline constexpr PeriodicTimer timer1{kTimer1, kTimer1Irq};

}  // namespace volcomp::hal::mps2
