#pragma once
// The other way to tables of one axis each, for comparison with the mean over the grid.

#include "comp/metrology/tables/per_axis.hpp"

namespace volcomp::test {

// Tables read off along three lines through an anchor point.
template <std::size_t Capacity, class ErrorAt>
void per_axis_anchored(const ErrorAt& error_at, const std::array<KnotGrid, 3>& grid,
                       const Vec3& anchor, PerAxisTables<Capacity>& out) {
  out.constant = error_at(anchor);
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < grid[j].knots; ++i) {
      Vec3 q = anchor;
      q(static_cast<Eigen::Index>(j)) = grid[j].at(i);
      out.f[j][i] = error_at(q) - out.constant;
    }
  }
  detail::measure_residual(error_at, grid, out);
}

}  // namespace volcomp::test
