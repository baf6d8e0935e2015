#pragma once
// Places at which a machine of any axes is measured: along its diagonals and all over its travel.

#include <vector>

#include "host_sim/sim/campaign/measured_diagonals.hpp"
#include "host_sim/sim/controller/motion_cell.hpp"

namespace volcomp::any_machine {

// The first three linear axes, in the order of the file.
[[nodiscard]] std::vector<std::size_t> slides_of(const host::MachineFile& file);

// Body diagonals (ISO 230-6) of three linear axes, both diagonals of two, the line of one, named as
// "PNP": the second axis runs downwards. A little shorter than the travels, so that every point can
// be approached; the rotary axes stand at their references.
[[nodiscard]] std::vector<sim::MeasuredLine> diagonals_of(const host::MachineFile& file);

// Random poses of all axes where the correcting ones can act. May be fewer than `count`.
[[nodiscard]] std::vector<Pose> random_poses(const host::MachineFile& file, std::size_t count,
                                             std::uint64_t seed);

// The reading at a pose of the machine.
struct PlaceReading {
  Pose pose{};
  sim::Approach approach{};             // sides from which the axes have arrived
  Vec3 deviation_mm = Vec3::Zero();     // that the correcting axes can reach, work frame
  Vec3 orientation_rad = Vec3::Zero();  // work frame
  double tilt_rad = 0.0;                // of the tool axis, Z of the tool frame
  double steerable_rad = 0.0;           // of it what the orienting axes reach with a firm grip
  host::Offsets offset{};               // of the compensation, run-time units
};

// The part of a position error, in the work frame, that the correcting axes can move; all of it
// where three axes correct.
[[nodiscard]] Vec3 within_reach(const MachineChain& chain, const Pose& q, const Vec3& error_work);

// The line in both directions; deviations along it that the correcting axes can reach.
[[nodiscard]] sim::MeasuredDiagonal measure_line(sim::MotionCell& cell, const MachineChain& chain,
                                                 const sim::MeasuredLine& line);

[[nodiscard]] std::vector<PlaceReading> measure_places(sim::MotionCell& cell,
                                                       const MachineChain& chain,
                                                       const std::vector<Pose>& poses);

}  // namespace volcomp::any_machine
