#include "host_sim/sim/drives/cia402_state_machine.hpp"

namespace volcomp::sim {
namespace {

// CiA 402-2, table of the controlword commands.
constexpr unsigned kSwitchOn = 1U << 0U;
constexpr unsigned kEnableVoltage = 1U << 1U;
constexpr unsigned kQuickStopOff = 1U << 2U;  // active low
constexpr unsigned kEnableOperation = 1U << 3U;

PowerState after_shutdown(PowerState state) {
  switch (state) {
    case PowerState::switch_on_disabled:  // transition 2
    case PowerState::switched_on:         // 6
    case PowerState::operation_enabled:   // 8
      return PowerState::ready_to_switch_on;
    default:
      return state;
  }
}

PowerState after_switch_on(PowerState state) {
  switch (state) {
    case PowerState::ready_to_switch_on:  // 3
    case PowerState::operation_enabled:   // 5: here the same bits mean "disable operation"
      return PowerState::switched_on;
    default:
      return state;
  }
}

PowerState after_enable_operation(PowerState state, bool stays_in_quick_stop) {
  switch (state) {
    case PowerState::ready_to_switch_on:  // 3 and, by itself, 4
    case PowerState::switched_on:         // 4
      return PowerState::operation_enabled;
    case PowerState::quick_stop_active:  // 16
      return stays_in_quick_stop ? PowerState::operation_enabled : state;
    default:
      return state;
  }
}

PowerState after_disable_voltage(PowerState state) {
  switch (state) {
    case PowerState::ready_to_switch_on:  // 7
    case PowerState::switched_on:         // 10
    case PowerState::operation_enabled:   // 9
    case PowerState::quick_stop_active:   // 12
      return PowerState::switch_on_disabled;
    default:
      return state;
  }
}

PowerState after_quick_stop(PowerState state) {
  switch (state) {
    case PowerState::ready_to_switch_on:  // 7
    case PowerState::switched_on:         // 10
      return PowerState::switch_on_disabled;
    case PowerState::operation_enabled:  // 11
      return PowerState::quick_stop_active;
    default:
      return state;
  }
}

}  // namespace

PowerCommand decode(std::uint16_t controlword) {
  if ((controlword & kControlFaultReset) != 0) return PowerCommand::none;
  if ((controlword & kEnableVoltage) == 0) return PowerCommand::disable_voltage;
  if ((controlword & kQuickStopOff) == 0) return PowerCommand::quick_stop;
  if ((controlword & kSwitchOn) == 0) return PowerCommand::shutdown;
  return (controlword & kEnableOperation) == 0 ? PowerCommand::switch_on
                                               : PowerCommand::enable_operation;
}

void PowerStateMachine::initialised() {
  if (state_ == PowerState::not_ready_to_switch_on) state_ = PowerState::switch_on_disabled;
}

void PowerStateMachine::control(std::uint16_t controlword, bool stays_in_quick_stop) {
  const bool reset_bit = (controlword & kControlFaultReset) != 0;
  const bool rising = reset_bit && !reset_bit_;
  reset_bit_ = reset_bit;
  if (rising && state_ == PowerState::fault) state_ = PowerState::switch_on_disabled;  // 15
  command(decode(controlword), stays_in_quick_stop);
}

void PowerStateMachine::command(PowerCommand command, bool stays_in_quick_stop) {
  switch (command) {
    case PowerCommand::none:
      break;
    case PowerCommand::shutdown:
      state_ = after_shutdown(state_);
      break;
    case PowerCommand::switch_on:
      state_ = after_switch_on(state_);
      break;
    case PowerCommand::enable_operation:
      state_ = after_enable_operation(state_, stays_in_quick_stop);
      break;
    case PowerCommand::disable_voltage:
      state_ = after_disable_voltage(state_);
      break;
    case PowerCommand::quick_stop:
      state_ = after_quick_stop(state_);
      break;
  }
}

void PowerStateMachine::fail() {
  if (state_ != PowerState::fault) state_ = PowerState::fault_reaction_active;
}

void PowerStateMachine::standstill(bool stays_in_quick_stop) {
  if (state_ == PowerState::fault_reaction_active) state_ = PowerState::fault;
  if (state_ == PowerState::quick_stop_active && !stays_in_quick_stop)
    state_ = PowerState::switch_on_disabled;
}

}  // namespace volcomp::sim
