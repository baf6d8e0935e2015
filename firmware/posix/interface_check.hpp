#pragma once
// What about the setup of a CAN interface does not suit the node (docs/linux-node.md). Told at the
// start, and no reason not to start.

#include <string>
#include <vector>

#include "hal/linux/can_interface.hpp"

namespace volcomp::posix {

// A sentence each, to stand after the name of the interface. `forwards`: drives take targets from
// this node (2034h = 1). Nothing is said of an interface without a controller, as vcan is.
[[nodiscard]] std::vector<std::string> remarks(const hal::CanInterface& found, bool forwards);

}  // namespace volcomp::posix
