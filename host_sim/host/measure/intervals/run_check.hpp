#pragma once
// Whether runs are enough for an interval.

#include <vector>

#include "comp/core/status.hpp"

namespace volcomp::host {

// Readings by run and target; an empty list is missing. Refused, in this order: missing_field
// (positions, up, down); by direction too_few_runs (fewer than 2), run_length; not_finite
// (positions, up, down); run_count_differs; positions_not_monotone (they must rise), too_few_points
// (fewer than 2 targets), no_spread (runs that are alike, or differ only by a constant each: such
// a constant is in no figure of means). Indices count from 0.
[[nodiscard]] Status check_runs(const std::vector<double>& positions,
                                const std::vector<std::vector<double>>& up,
                                const std::vector<std::vector<double>>& down);

}  // namespace volcomp::host
