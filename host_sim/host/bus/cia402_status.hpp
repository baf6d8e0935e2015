#pragma once
// The statusword of a drive (CiA 402-2): the states of its power section, the pattern of each, and
// the bits beside them.

#include <cstdint>

namespace volcomp::host {

enum class PowerState : std::uint8_t {
  not_ready_to_switch_on,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
};

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

// Bits 0…3, 5 and 6 of the statusword.
[[nodiscard]] std::uint16_t status_pattern(PowerState state);

}  // namespace volcomp::host
