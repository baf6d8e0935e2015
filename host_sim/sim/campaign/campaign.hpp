#pragma once
// Measuring the simulated machine: six-degree-of-freedom laser on every axis, ball bar for
// squareness.

#include <vector>

#include "comp/metrology/tables/diagonals.hpp"
#include "comp/metrology/tables/lever_test.hpp"
#include "host_sim/host/machine/machine_file.hpp"
#include "host_sim/host/tables/runs_csv.hpp"
#include "host_sim/sim/instruments/noise_classes.hpp"
#include "host_sim/sim/truth/noise.hpp"
#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

inline constexpr std::size_t kDiagonalPoints = 37;  // between the knots of 10 equal steps
inline constexpr std::size_t kKnotPoints = 11;      // the paper's 10 equal steps
inline constexpr std::size_t kPnp = 2;              // the paper's diagonal, in body_diagonals()

// What a campaign leaves behind: run files and a machine file with the squareness as measured.
struct Campaign {
  host::MachineFile machine;
  std::vector<host::RunsFile> runs;
};

// `runs` bidirectional runs per axis at the equally spaced targets of the machine file.
[[nodiscard]] Campaign measure_machine(const TrueMachine& truth, const host::MachineFile& file,
                                       const NoiseClasses& classes, std::size_t runs,
                                       const CampaignDraw& draw);

// Noise-free, one run.
[[nodiscard]] Campaign perfect_campaign(const TrueMachine& truth, const host::MachineFile& file);

// Positioning measured again at a second place of every axis: the difference must be the angles
// times the levers.
struct LeverCheck {
  char axis = '\0';
  LeverTest test;
  Status status;
};
[[nodiscard]] std::vector<LeverCheck> check_levers(const TrueMachine& truth,
                                                   const host::MachineFile& file,
                                                   const NoiseClasses& classes, std::size_t runs,
                                                   const CampaignDraw& draw);

[[nodiscard]] DiagonalBox travel_box(const host::MachineFile& file);

}  // namespace volcomp::sim
