#pragma once
// 2300h to 2304h, 2311h and 2312h: what the node needs to know of the touch probe, of the part on
// the table and, where one is measured, of its face gear.

#include <array>

#include "comp/probe/face_gear.hpp"
#include "comp/probe/probe_corrector.hpp"
#include "host_sim/host/bus/setup_plan.hpp"

namespace volcomp::host {

// Lengths in mm, angles in rad.
struct NodeProbe {
  double delay_us = 0.0;                          // from contact to the edge at the drives
  std::array<double, kMaxAxes> latch_delay_us{};  // from the edge to the latch of an axis
  LobingMap radius{};                             // effective, by direction in the tool frame
  Frame workpiece{};                              // of the part in the frame of the work
  double radius_uncertainty = 0.0;                // standard
  double tool_length_uncertainty = 0.0;           //
  double repeatability = 0.0;                     // along the normal
  std::uint32_t gear_id = 0;                      // 0: no face gear
  FaceGear gear{};                                // derived; its frame is that of the workpiece
};

// Delays and radius of the machine file, the part where the work is. Throws UserError when the file
// describes no probe.
[[nodiscard]] NodeProbe node_probe(const MachineFile& machine);

// All of it; the last value has the node check and adopt it, and switches the probe on.
[[nodiscard]] SetupPlan probe_plan(const NodeProbe& probe);

}  // namespace volcomp::host
