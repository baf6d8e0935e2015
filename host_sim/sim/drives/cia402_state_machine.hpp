#pragma once
// The finite state automaton of a power drive system (CiA 402-2, "FSA"): the commands of the
// controlword and what they do.

#include <cstdint>

#include "host_sim/host/bus/cia402_status.hpp"

namespace volcomp::sim {

// The command of a controlword, without fault reset, which is an edge, not a level.
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

// A `controlword` with bit 7 set is no command: every command needs it to be 0.
[[nodiscard]] PowerCommand decode(std::uint16_t controlword);

class PowerStateMachine {
 public:
  [[nodiscard]] host::PowerState state() const { return state_; }
  [[nodiscard]] bool enabled() const { return state_ == host::PowerState::operation_enabled; }

  void power_on() { *this = {}; }
  // Transition 1: the self-test is over.
  void initialised();

  // A controlword has arrived. `stays_in_quick_stop`: 605Ah is 5…8, so that transition 16 exists
  // and transition 12 waits for a command.
  void control(std::uint16_t controlword, bool stays_in_quick_stop);
  // The same as by controlword, for a lost connection (6007h).
  void command(PowerCommand command, bool stays_in_quick_stop);
  // Transition 13.
  void fail();
  // The axis stands: the end of a quick stop or of a fault reaction (transitions 12 and 14).
  void standstill(bool stays_in_quick_stop);

 private:
  host::PowerState state_ = host::PowerState::not_ready_to_switch_on;
  bool reset_bit_ = false;
};

}  // namespace volcomp::sim
