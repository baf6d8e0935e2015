#pragma once
// The interrupt controller (Arm Generic Interrupt Controller version 2, IHI 0048B). All interrupts
// have one priority and go to the first processor: a handler is never interrupted, except by a fast
// interrupt, which has a mask bit of its own in the processor.

#include <cstdint>

#include "hal/virt/registers.hpp"

namespace volcomp::hal::virt::gic {

inline constexpr std::uint32_t kNone = 1023;  // acknowledge(): it was withdrawn meanwhile

// Every interrupt into group 1, whose requests arrive as IRQ; those of group 0 arrive as FIQ.
inline void start() {
  constexpr std::uint32_t kGroups = 64 / 32;  // more interrupts than the machine uses
  constexpr std::uint32_t kEveryPriority = 0xFF;
  constexpr std::uint32_t kBothGroups = 3;
  constexpr std::uint32_t kOneAcknowledge = 1U << 2U;
  constexpr std::uint32_t kFastInterrupts = 1U << 3U;
  for (Address i = 0; i < kGroups; ++i)
    word_register(kGicDistributor + 0x080 + 4 * i) = ~0U;
  word_register(kGicDistributor) = kBothGroups;
  word_register(kGicInterface + 0x4) = kEveryPriority;
  word_register(kGicInterface) = kBothGroups | kOneAcknowledge | kFastInterrupts;
}

// `id` as in hal/virt/registers.hpp.
inline void enable(std::uint32_t id) {
  constexpr std::uint8_t kPriority = 0x80;
  constexpr std::uint8_t kFirstProcessor = 1;
  byte_register(kGicDistributor + 0x400 + id) = kPriority;
  byte_register(kGicDistributor + 0x800 + id) = kFirstProcessor;
  word_register(kGicDistributor + 0x100 + 4 * Address{id / 32U}) = 1U << (id % 32U);
}

// More urgent than all others; below 32.
inline void enable_fast(std::uint32_t id) {
  word_register(kGicDistributor + 0x080) &= ~(1U << id);
  byte_register(kGicDistributor + 0x400 + id) = 0;
  word_register(kGicDistributor + 0x100) = 1U << id;
}

// Once each, at the begin and at the end of handling an interrupt.
inline std::uint32_t acknowledge() {
  constexpr std::uint32_t kId = 0x3FF;
  return word_register(kGicInterface + 0xC) & kId;
}
inline void finish(std::uint32_t id) { word_register(kGicInterface + 0x10) = id; }

}  // namespace volcomp::hal::virt::gic
