#pragma once
// The simulated XYFZ machine as its owner would measure it: run files, diagonals and error vectors
// of whatever compensation is at work.

#include "host_sim/experiments/xyfz/scenario.hpp"
#include "host_sim/host/measure/diagonal_csv.hpp"
#include "host_sim/host/measure/volume_csv.hpp"
#include "host_sim/host/report/progress.hpp"
#include "host_sim/sim/campaign/campaign.hpp"

namespace volcomp::xyfz {

// The machine of run_xyfz, described by a file and with errors of its own.
struct SimulatedMachine {
  host::MachineFile machine;
  sim::TrueMachine truth;
};
// Throws UserError.
[[nodiscard]] SimulatedMachine simulated_machine(const std::filesystem::path& path,
                                                 std::uint64_t machine_seed);

struct Instruments {
  bool perfect = false;  // else with the errors of NoiseClasses
  std::uint64_t seed = 1;
};

// Bidirectional runs of every axis.
[[nodiscard]] std::vector<host::RunsFile> simulate_runs(const SimulatedMachine& simulated,
                                                        const Instruments& instruments,
                                                        std::size_t runs);

struct DiagonalPlan {
  bool faces = false;  // the six of the faces, too
  std::size_t points = sim::kKnotPoints;
  std::size_t runs = 5;  // in each direction
};
// The machine moves along every diagonal as often as there are runs.
[[nodiscard]] host::DiagonalsFile simulate_diagonals(sim::MotionCell& cell,
                                                     const host::MachineFile& machine,
                                                     const DiagonalPlan& plan,
                                                     const Instruments& instruments,
                                                     const host::Progress& progress);

// Random places of the travel, the same for the same seed.
[[nodiscard]] host::VolumeFile simulate_volume(sim::MotionCell& cell,
                                               const host::MachineFile& machine, int points,
                                               std::uint64_t seed);

}  // namespace volcomp::xyfz
