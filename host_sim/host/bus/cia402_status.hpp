#pragma once
// The statusword of a drive (CiA 402-2): the states of its power section, the pattern of each, and
// the bits beside them.

#include <cstdint>

namespace volcomp::host {

// Each is its pattern, bits 0…3, 5 and 6 of the statusword.
enum class PowerState : std::uint16_t {
  not_ready_to_switch_on = 0x0000,
  switch_on_disabled = 0x0040,
  ready_to_switch_on = 0x0021,
  switched_on = 0x0023,
  operation_enabled = 0x0027,
  quick_stop_active = 0x0007,
  fault_reaction_active = 0x000F,
  fault = 0x0008,
};
constexpr std::uint16_t status_pattern(PowerState state) {
  return static_cast<std::uint16_t>(state);
}

// Bits of 6041h that do not belong to the state.
enum DriveStatusBit : std::uint16_t {
  kStatusVoltageEnabled = 1U << 4U,
  kStatusReferenced = 1U << 8U,  // manufacturer-specific: position referenced
  kStatusRemote = 1U << 9U,
  kStatusTargetReached = 1U << 10U,
  kStatusInternalLimit = 1U << 11U,
  kStatusFollowsCommand = 1U << 12U,  // cyclic synchronous position
  kStatusHomingAttained = 1U << 12U,  // homing
  kStatusFollowingError = 1U << 13U,  // cyclic synchronous position
};

}  // namespace volcomp::host
