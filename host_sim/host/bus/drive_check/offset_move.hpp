#pragma once
// Whether 60B0h of a drive is the position offset that CiA 402-2 means by it: writes it while the
// drive is not enabled, and looks at the position demand value. In some old firmware 60B0h starts
// the drive.

#include <array>

#include "host_sim/host/bus/drive_check/drive_changes.hpp"
#include "host_sim/host/bus/drive_check/foreign_drive.hpp"

namespace volcomp::host {

inline constexpr std::int32_t kMovedUnits = 10;

// Throws UserError with one sentence: no 60B0h of four bytes, no value to look at, or the power
// stage is on.
void require_movable(NodeClient& client, const ForeignDrive& drive);

// After that. Writes 60B0h = +10, -10, +10, -10 units; it is as it was afterwards. Stops when the
// drive is enabled meanwhile. Throws NotRestored, and what ended it.
[[nodiscard]] MovedDemand move_offset(NodeClient& client, DriveChanges& changes,
                                      const ForeignDrive& drive);

// From the values of 6062h after the four writes.
[[nodiscard]] MovedDemand judge_demand(const std::array<std::int32_t, 4>& demand);

}  // namespace volcomp::host
