#pragma once
// Network management: the states and commands of a device (CiA 301, section 7.3.2).

#include <cstdint>

namespace volcomp::canopen {

// As in the heartbeat message.
enum class NmtState : std::uint8_t {
  boot_up = 0,
  stopped = 4,
  operational = 5,
  pre_operational = 127,
};

enum class NmtCommand : std::uint8_t {
  start = 1,
  stop = 2,
  enter_pre_operational = 128,
  reset_node = 129,
  reset_communication = 130,
};

}  // namespace volcomp::canopen
