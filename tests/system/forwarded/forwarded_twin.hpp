#pragma once
// The same bus without node: the drives take 6040h and 607Ah from the frames of the controller, as
// they were in the other run and with what befell them there.

#include <string>

#include "tests/system/forwarded/forwarded_world.hpp"

namespace volcomp::sim {

// Empty when each drive that does not watch the node had the same 6040h at every SYNC in both, and
// its target in `world` was at most as many cycles older as frames of the node were hit in a row.
// Else the first difference.
[[nodiscard]] std::string difference_without_node(const ForwardedWorld& world);

}  // namespace volcomp::sim
