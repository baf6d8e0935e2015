#include "host_sim/sim/drives/cia402_state_machine.hpp"

namespace volcomp::sim {
namespace {

// CiA 402-2, table of the controlword commands.
constexpr unsigned kSwitchOn = 1U << 0U;
constexpr unsigned kEnableVoltage = 1U << 1U;
constexpr unsigned kQuickStopOff = 1U << 2U;  // active low
constexpr unsigned kEnableOperation = 1U << 3U;

host::PowerState after_shutdown(host::PowerState state) {
  switch (state) {
    case host::PowerState::switch_on_disabled:  // transition 2
    case host::PowerState::switched_on:         // 6
    case host::PowerState::operation_enabled:   // 8
      return host::PowerState::ready_to_switch_on;
    default:
      return state;
  }
}

host::PowerState after_switch_on(host::PowerState state) {
  switch (state) {
    case host::PowerState::ready_to_switch_on:  // 3
    case host::PowerState::operation_enabled:   // 5: here the same bits mean "disable operation"
      return host::PowerState::switched_on;
    default:
      return state;
  }
}

host::PowerState after_enable_operation(host::PowerState state, bool stays_in_quick_stop) {
  switch (state) {
    case host::PowerState::ready_to_switch_on:  // 3 and, by itself, 4
    case host::PowerState::switched_on:         // 4
      return host::PowerState::operation_enabled;
    case host::PowerState::quick_stop_active:  // 16
      return stays_in_quick_stop ? host::PowerState::operation_enabled : state;
    default:
      return state;
  }
}

host::PowerState after_disable_voltage(host::PowerState state) {
  switch (state) {
    case host::PowerState::ready_to_switch_on:  // 7
    case host::PowerState::switched_on:         // 10
    case host::PowerState::operation_enabled:   // 9
    case host::PowerState::quick_stop_active:   // 12
      return host::PowerState::switch_on_disabled;
    default:
      return state;
  }
}

host::PowerState after_quick_stop(host::PowerState state) {
  switch (state) {
    case host::PowerState::ready_to_switch_on:  // 7
    case host::PowerState::switched_on:         // 10
      return host::PowerState::switch_on_disabled;
    case host::PowerState::operation_enabled:  // 11
      return host::PowerState::quick_stop_active;
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
  if (state_ == host::PowerState::not_ready_to_switch_on)
    state_ = host::PowerState::switch_on_disabled;
}

void PowerStateMachine::control(std::uint16_t controlword, bool stays_in_quick_stop) {
  const bool reset_bit = (controlword & kControlFaultReset) != 0;
  const bool rising = reset_bit && !reset_bit_;
  reset_bit_ = reset_bit;
  if (rising && state_ == host::PowerState::fault)
    state_ = host::PowerState::switch_on_disabled;  // 15
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
  if (state_ != host::PowerState::fault) state_ = host::PowerState::fault_reaction_active;
}

void PowerStateMachine::standstill(bool stays_in_quick_stop) {
  if (state_ == host::PowerState::fault_reaction_active) state_ = host::PowerState::fault;
  if (state_ == host::PowerState::quick_stop_active && !stays_in_quick_stop)
    state_ = host::PowerState::switch_on_disabled;
}

}  // namespace volcomp::sim
