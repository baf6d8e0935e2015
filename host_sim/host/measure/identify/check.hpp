#pragma once
// What a problem is refused for, in the order in which a user would want to know it.

#include <optional>
#include <string>
#include <vector>

#include "comp/core/status.hpp"
#include "host_sim/host/measure/identify/solution.hpp"

namespace volcomp::host::identify {

// The reason and its place; empty where it does not apply.
struct Refusal {
  Reason reason = Reason::ok;
  std::string setup;
  std::string stylus;
  std::string artefact;
  std::string field;
  std::string axis;
  std::optional<std::size_t> index;              // of an observation, from 0
  std::optional<std::size_t> nullity_functions;  // PlanRank; beyond the gauge for not_observable
  std::vector<std::string> names;                // of what is not seen

  [[nodiscard]] bool ok() const { return reason == Reason::ok; }
};

// Everything that is to be known before an estimate. Reasons: missing_field, duplicate_id,
// unknown_reference, length_mismatch, not_finite, sigma_not_positive, reference_stylus,
// position_out_of_range, unit_suspected, station_in_path, too_few_observations, collinear,
// axis_never_moved, not_observable, gauge_excess.
[[nodiscard]] Refusal check_problem(const Problem& problem);

// not_converged, or contradictory: χ² of 25 a degree of freedom.
[[nodiscard]] Refusal check_solution(const Solution& solution);

}  // namespace volcomp::host::identify
