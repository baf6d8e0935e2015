#pragma once
// 2500h to 2505h: what a node that watches the strokes of a helical grinder needs to know of gear,
// lines and learning.

#include "host_sim/host/bus/setup_plan.hpp"

namespace volcomp::host {

// The last value has the node check and adopt them all. Throws UserError when X, Z or C is not on
// the bus.
[[nodiscard]] SetupPlan stroke_plan(const BusSettings& settings, const WatchedStrokes& strokes);

}  // namespace volcomp::host
