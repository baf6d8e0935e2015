#pragma once
// Keeps all interrupts out of the first processor (PSTATE.I, Arm DDI 0487, C5.2.2). They stay
// pending and come when the mask is lifted.

#include <cstdint>

namespace volcomp::hal::virt {

// For a scope; may be nested and used inside a handler.
class InterruptLock {
 public:
  InterruptLock() { __asm volatile("mrs %0, daif\n msr daifset, #2" : "=r"(before_) : : "memory"); }
  ~InterruptLock() { __asm volatile("msr daif, %0" : : "r"(before_) : "memory"); }
  InterruptLock(const InterruptLock&) = delete;
  InterruptLock& operator=(const InterruptLock&) = delete;

 private:
  std::uint64_t before_ = 0;
};

// The critical section of hal/critical_section.hpp.
class InterruptMask {
 public:
  // Not static, so that they are called like those of any other critical section.
  // NOLINTBEGIN(readability-convert-member-functions-to-static)
  void enter() { __asm volatile("msr daifset, #2" : : : "memory"); }
  void leave() { __asm volatile("msr daifclr, #2" : : : "memory"); }
  // NOLINTEND(readability-convert-member-functions-to-static)
};

inline void wait_for_interrupt() { __asm volatile("wfi" : : : "memory"); }

}  // namespace volcomp::hal::virt
