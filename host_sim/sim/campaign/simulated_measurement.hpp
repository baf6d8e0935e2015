#pragma once
// A simulated machine as its owner would measure it: run files, diagonals and error vectors, with
// the compensation that is at work.

#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/measure/diagonal_csv.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/sim/campaign/campaign.hpp"
#include "host_sim/sim/controller/motion_cell.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

// A machine as its file describes it, with drawn errors, for trying the tools without a real one.
struct SimulatedMachine {
  host::MachineFile machine;
  TrueMachine truth;
};

// Error motions of the linear axes drawn at random, the same for the same seed; rotary axes turn
// without errors. Where the file states a value, the machine has it: a ball bar reads the
// [squareness], and at their references the axes have the errors stated for them. Without
// [squareness] its axes are square, and what was measured of their straightness has no slope.
[[nodiscard]] TrueMachine draw_slides(const host::MachineFile& file, std::uint64_t seed);

// The file with targets so that one of them is at the reference of each axis, as tables need it:
// more targets where that is enough, else a grid that begins and ends up to one pitch inside the
// travel.
[[nodiscard]] host::MachineFile with_targets_at_references(host::MachineFile file);

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
