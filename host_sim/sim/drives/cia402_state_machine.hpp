#pragma once
// The finite state automaton of a power drive system (CiA 402-2, "FSA"): states, the commands of
// the controlword, the statusword pattern of each state.

#include <cstdint>

namespace volcomp::sim {

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

// What a controlword asks for, fault reset apart: that one is an edge, not a level.
enum class PowerCommand : std::uint8_t {
  none,
  shutdown,
  switch_on,
  enable_operation,
  disable_voltage,
  quick_stop,
};

// Bits of 6040h with a meaning of their own.
inline constexpr std::uint16_t kControlHomingStart = 1U << 4U;
inline constexpr std::uint16_t kControlFaultReset = 1U << 7U;

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

// `controlword` with bit 7 set asks for nothing: every command needs it to be 0.
[[nodiscard]] PowerCommand decode(std::uint16_t controlword);

// Bits 0…3, 5 and 6 of the statusword.
[[nodiscard]] std::uint16_t status_pattern(PowerState state);

class PowerStateMachine {
 public:
  [[nodiscard]] PowerState state() const { return state_; }
  [[nodiscard]] bool enabled() const { return state_ == PowerState::operation_enabled; }

  void power_on() { *this = {}; }
  // Transition 1: the self-test is over.
  void initialised();

  // A controlword has arrived. `stays_in_quick_stop`: 605Ah is 5…8, so that transition 16 exists
  // and transition 12 waits for a command.
  void control(std::uint16_t controlword, bool stays_in_quick_stop);
  // The same as if the controlword had asked for it, for a lost connection (6007h).
  void command(PowerCommand command, bool stays_in_quick_stop);
  // Transition 13.
  void fail();
  // The axis stands: the end of a quick stop or of a fault reaction (transitions 12 and 14).
  void standstill(bool stays_in_quick_stop);

 private:
  PowerState state_ = PowerState::not_ready_to_switch_on;
  bool reset_bit_ = false;
};

}  // namespace volcomp::sim
