#pragma once
// What the node reads in status word and controlword of a drive (CiA 402-2, tables 29 and 33).

#include <cstdint>

namespace volcomp::node {

// xxxx xxxx x01x 0111b.
constexpr bool operation_enabled(std::uint16_t status_word) {
  return (status_word & 0x006FU) == 0x0027U;
}
// Bit 11: an internal limit is active.
constexpr bool internally_limited(std::uint16_t status_word) {
  return (status_word & 0x0800U) != 0;
}

// The command "enable operation", 0xxx 1111b.
constexpr bool enables_operation(std::uint16_t control_word) {
  return (control_word & 0x008FU) == 0x000FU;
}

}  // namespace volcomp::node
