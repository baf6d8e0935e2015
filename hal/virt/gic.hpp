#pragma once
// The interrupt controller (Arm Generic Interrupt Controller version 2, IHI 0048B). All interrupts
// have one priority and go to the first processor: a handler is never interrupted.

#include <cstdint>

#include "hal/virt/registers.hpp"

namespace volcomp::hal::virt::gic {

inline constexpr std::uint32_t kNone = 1023;  // acknowledge(): it was withdrawn meanwhile

inline void start() {
  constexpr std::uint32_t kEveryPriority = 0xFF;
  word_register(kGicDistributor) = 1;
  word_register(kGicInterface + 0x4) = kEveryPriority;
  word_register(kGicInterface) = 1;
}

// `id` as in hal/virt/registers.hpp.
inline void enable(std::uint32_t id) {
  constexpr std::uint8_t kFirstProcessor = 1;
  byte_register(kGicDistributor + 0x800 + id) = kFirstProcessor;
  word_register(kGicDistributor + 0x100 + 4 * Address{id / 32U}) = 1U << (id % 32U);
}

// Once each, at the begin and at the end of handling an interrupt.
inline std::uint32_t acknowledge() {
  constexpr std::uint32_t kId = 0x3FF;
  return word_register(kGicInterface + 0xC) & kId;
}
inline void finish(std::uint32_t id) { word_register(kGicInterface + 0x10) = id; }

}  // namespace volcomp::hal::virt::gic
