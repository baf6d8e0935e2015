#pragma once
// A simulated machine as its owner would measure it: run files, diagonals and error vectors, with
// the compensation that is at work.

#include "host_sim/host/measure/diagonal_csv.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/campaign/simulated_machine.hpp"
#include "host_sim/sim/controller/motion_cell.hpp"

namespace volcomp::sim {

struct Instruments {
  bool perfect = false;  // else with the errors of NoiseClasses
  std::uint64_t seed = 1;
};

// Bidirectional runs of every axis; those of a rotary axis show what its file states of it.
[[nodiscard]] std::vector<host::RunsFile> simulate_runs(const SimulatedMachine& simulated,
                                                        const Instruments& instruments,
                                                        std::size_t runs);

struct DiagonalPlan {
  bool faces = false;  // the six of the faces, too
  std::size_t points = kKnotPoints;
  std::size_t runs = 5;  // in each direction
};
// The machine moves along every diagonal as often as there are runs; axes other than X, Y and Z
// stand still at 0. Two of the three have two diagonals. Throws UserError where there are fewer.
[[nodiscard]] host::DiagonalsFile simulate_diagonals(MotionCell& cell,
                                                     const host::MachineFile& machine,
                                                     const DiagonalPlan& plan,
                                                     const Instruments& instruments,
                                                     const host::Progress& progress);

// Random places of the travel of X, Y and Z, the same for the same seed; other axes stand still at
// 0. Places and error vectors are in the work frame.
[[nodiscard]] host::VolumeFile simulate_volume(MotionCell& cell, const host::MachineFile& machine,
                                               int points, std::uint64_t seed);

}  // namespace volcomp::sim
