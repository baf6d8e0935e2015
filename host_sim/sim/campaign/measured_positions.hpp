#pragma once
// Measures the machine as an acceptance test does: positioning of every axis after ISO 230-2, and
// the error vector on a grid over the work volume. It moves, with whatever compensation it has.

#include "host_sim/host/report/positioning.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/campaign/measured_diagonals.hpp"
#include "host_sim/sim/truth/noise.hpp"

namespace volcomp::sim {

// Each axis at the targets of the machine file, the others at mid travel; `runs` bidirectional runs
// with an interferometer of this repeatability. Zero at the first target, mean of both directions.
[[nodiscard]] std::vector<host::Positioning> measure_positioning(MotionCell& cell,
                                                                 const host::MachineFile& machine,
                                                                 const std::string& when,
                                                                 const InterferometerSetup& setup,
                                                                 Random& random);

inline constexpr std::size_t kVolumeGrid = 4;  // points along each edge

[[nodiscard]] std::vector<Vec3> volume_grid(const DiagonalBox& box);
// At these points, mm, as they are: without aligning a workpiece frame.
[[nodiscard]] std::vector<Vec3> measure_errors(MotionCell& cell, const std::vector<Vec3>& points);

}  // namespace volcomp::sim
