#include "host_sim/host/bus/cia402_status.hpp"

namespace volcomp::host {

std::uint16_t status_pattern(PowerState state) {
  switch (state) {
    case PowerState::not_ready_to_switch_on:
      return 0x0000;
    case PowerState::switch_on_disabled:
      return 0x0040;
    case PowerState::ready_to_switch_on:
      return 0x0021;
    case PowerState::switched_on:
      return 0x0023;
    case PowerState::operation_enabled:
      return 0x0027;
    case PowerState::quick_stop_active:
      return 0x0007;
    case PowerState::fault_reaction_active:
      return 0x000F;
    case PowerState::fault:
      return 0x0008;
  }
  return 0x0000;
}

}  // namespace volcomp::host
