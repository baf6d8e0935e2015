#pragma once
// The order in which an axis is measured: up through all targets and down again, run after run.

#include <functional>
#include <vector>

#include "comp/machine/error_motion.hpp"
#include "host_sim/host/tables/runs_csv.hpp"

namespace volcomp::sim {

// Where a slide stops to be read, and where it stopped before.
struct Stop {
  double q = 0.0;
  double approach = 0.0;  // side from which it arrives: −1 or +1
  double q_before = 0.0;
  double approach_before = 0.0;
  std::uint32_t number = 0;  // in the order of travel
};

// Runs up and down at these positions of an axis, mm or rad: up through all, then down again.
[[nodiscard]] host::RunsFile bidirectional_runs(
    char letter, const std::vector<double>& positions, std::size_t runs,
    const std::function<ErrorMotion(const Stop&)>& reading);

// Mean of all runs of both directions, by target.
[[nodiscard]] std::vector<ErrorMotion> mean_of_runs(const host::RunsFile& runs);

}  // namespace volcomp::sim
