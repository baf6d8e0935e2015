#pragma once
// The estimate: Gauss–Newton on everything at once, weights as stated, or with Huber's weights.

#include <string>
#include <vector>

#include "host_sim/host/measure/identify/equations.hpp"
#include "host_sim/host/measure/identify/triangle.hpp"

namespace volcomp::host::identify {

struct Solution {
  Estimate estimate;
  Triangle triangle;  // of the last step
  double chi2 = 0.0;  // of weighted readings and of what was known before
  Index dof = 0;
  int steps = 0;
  bool converged = false;
  bool robust = false;
  // Beyond five times the robust spread; never dropped.
  std::vector<ReadingPlace> outliers;

  // Of a quantity at one of its places.
  [[nodiscard]] double value(const VectorXd& row) const { return row.dot(estimate.x); }
};

// Of at least one value.
[[nodiscard]] double median(std::vector<double> values);

// From `start`, or from Equations::start().
[[nodiscard]] Solution solve(const Equations& equations, bool robust);
[[nodiscard]] Solution solve_from(const Equations& equations, const Estimate& start, bool robust);

// Triangle at an estimate, without a step.
[[nodiscard]] Triangle triangle_at(const Equations& equations, const Estimate& e,
                                   const KnownBefore& known);

}  // namespace volcomp::host::identify
