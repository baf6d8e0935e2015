#pragma once
// Least squares row by row, without storing the rows.

#include <cmath>

#include <Eigen/Core>

namespace volcomp {

// Turns a further row into an upper triangle, so that triangleᵀ triangle grows by rowᵀ row (Givens
// rotations). Singular values come from the rows themselves: squared in a normal matrix, the small
// ones would drown in rounding.
template <int N>
void fold_row(Eigen::Matrix<double, N, N>& triangle, Eigen::Matrix<double, 1, N> row) {
  for (Eigen::Index i = 0; i < N; ++i) {
    if (!(std::abs(row(i)) > 0.0)) continue;
    const double length = std::hypot(triangle(i, i), row(i));
    const double c = triangle(i, i) / length;
    const double s = row(i) / length;
    for (Eigen::Index j = i; j < N; ++j) {
      const double kept = triangle(i, j);
      triangle(i, j) = c * kept + s * row(j);
      row(j) = c * row(j) - s * kept;
    }
  }
}

}  // namespace volcomp
