#pragma once
// The critical section of hal/critical_section.hpp: holds back the tick interrupt, nothing else.
// BASEPRI, not PRIMASK, so that bytes of the link still arrive (DDI 0403, B1.4.3).

#include <cstdint>

#include "hal/mps2/nvic.hpp"

namespace volcomp::hal::mps2 {

class TickMask {
 public:
  // Not static, so that they are called like those of any other critical section.
  // NOLINTBEGIN(readability-convert-member-functions-to-static)
  void enter() { __asm volatile("msr basepri, %0" : : "r"(nvic::kTickPriority) : "memory"); }
  void leave() { __asm volatile("msr basepri, %0" : : "r"(0) : "memory"); }
  // NOLINTEND(readability-convert-member-functions-to-static)
};

}  // namespace volcomp::hal::mps2
