#pragma once
// Network management: the states and commands of a device (CiA 301, section 7.3.2).

#include <cstdint>

namespace volcomp::canopen {

// As in the heartbeat message.
enum class NmtState : std::uint8_t {
#define NMT_STATE(number, name, title, words) name = (number),
#include "firmware/canopen/codes.def"
};

enum class NmtCommand : std::uint8_t {
  start = 1,
  stop = 2,
  enter_pre_operational = 128,
  reset_node = 129,
  reset_communication = 130,
};

}  // namespace volcomp::canopen
