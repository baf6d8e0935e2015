#pragma once
// The shortest verification there is: the paper's body diagonal PNP at its 11 points, without and
// with compensation by the closed model. For nodes that take long: an emulated board behind a real
// CAN interface.

#include <nlohmann/json.hpp>

#include "host_sim/experiments/xyfz/scenario.hpp"

namespace volcomp::xyfz {

struct OneDiagonal {
  sim::MeasuredDiagonal uncompensated;
  sim::MeasuredDiagonal compensated;

  [[nodiscard]] double rate() const;  // per cent of the largest deviation removed
  [[nodiscard]] bool ok() const;      // as much as the whole scenario demands
};

// Noise-free. Uses the options machine, machine_seed and make_cell. Throws UserError.
[[nodiscard]] OneDiagonal run_one_diagonal(const XyfzOptions& options,
                                           const host::Progress& progress);

// Every deviation, for other programs and for people.
[[nodiscard]] nlohmann::json one_diagonal_figures(const OneDiagonal& result);
[[nodiscard]] std::string one_diagonal_summary(const OneDiagonal& result);

}  // namespace volcomp::xyfz
