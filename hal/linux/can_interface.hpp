#pragma once
// How a CAN interface is set up, as `ip -details link show can0` says it: asked once, by rtnetlink.

#include <cstdint>

#include "comp/core/span.hpp"

namespace volcomp::hal {

struct CanInterface {
  bool known = false;            // the kernel has answered
  bool controller = false;       // of a CAN controller; false: vcan and others without a bit rate
  bool echoes = false;           // the driver gives frames back when they have been on the bus
  std::uint32_t bit_rate = 0;    // bit/s; 0: the driver does not know
  std::uint32_t queue = 0;       // frames (txqueuelen)
  std::uint32_t restart_ms = 0;  // after bus-off; 0: stays off
  bool reports_bus_errors = false;  // berr-reporting
};

// The answer to RTM_GETLINK (rtnetlink(7), linux/if_link.h, linux/can/netlink.h); not known where
// it is anything else.
[[nodiscard]] CanInterface parse_link(Span<const std::uint8_t> message);
// Not known where netlink cannot be used or has no such interface. Takes at most a second.
[[nodiscard]] CanInterface ask_link(const char* interface);

}  // namespace volcomp::hal
