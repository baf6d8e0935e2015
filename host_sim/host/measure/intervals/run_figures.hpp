#pragma once
// Figures of ISO 230-2 and the curve of means, from runs: what the standard defines, noise and all.

#include <vector>

#include "comp/core/status.hpp"
#include "comp/metrology/tables/iso230.hpp"

namespace volcomp::host {

struct RunFigures {
  std::size_t runs = 0;  // of the direction with fewer
  bool both_directions = false;
  Iso230Figures iso;          // of one direction only: as if the other were alike
  std::vector<double> curve;  // mean of both directions, from the first target on
  double largest = 0.0;       // magnitude of the curve
};

// Readings by run and target, in one unit; at least one run, all of the same targets. Refused as by
// iso230_figures.
[[nodiscard]] Status run_figures(const std::vector<std::vector<double>>& up,
                                 const std::vector<std::vector<double>>& down, RunFigures& out);

}  // namespace volcomp::host
