#pragma once
// How far runs scatter along a travel: one smooth variance for every place and direction, so that
// few runs tell enough about it.

#include <valarray>
#include <vector>

#include <Eigen/Core>

namespace volcomp::host {

// One number a column: the targets of one direction, then those of the other, in the same order.
using Columns = std::valarray<double>;

struct RunReadings {
  std::vector<double> position;  // of the targets, ascending
  std::vector<Columns> run;

  [[nodiscard]] std::size_t columns() const { return 2 * position.size(); }
  [[nodiscard]] Columns mean() const;
};

struct RunSpread {
  double freedom = 0.0;  // (n − 1)(q − 1)
  double pooled = 0.0;   // variance without what whole runs share, mean over the columns
  double total = 0.0;    // and with it
  double run = 0.0;      // what they share beyond that: max(0, total/pooled − 1)
  // ln σ² = b₀ + b₁P₁ + b₂P₂ ± b₃: along the travel, and between directions.
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the three
  std::vector<Eigen::Vector3d> shape;                    // P₁, P₂, ±1 of every column
  Columns v;                                             // fitted variances of a single reading

  [[nodiscard]] Columns v_total() const { return (1.0 + run) * v; }
};

// At least two runs that are not all alike, two targets.
[[nodiscard]] RunSpread run_spread(const RunReadings& readings);

}  // namespace volcomp::host
