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
  // Past Eigen's checks of every index, which below the sanitizers take longer than the sums. Eigen
  // stores column by column.
  double* const at = triangle.data();
  double* const row_at = row.data();
  for (Eigen::Index i = 0; i < N; ++i) {
    if (!(std::abs(row(i)) > 0.0)) continue;
    const double length = std::hypot(triangle(i, i), row(i));
    const double c = triangle(i, i) / length;
    const double s = row(i) / length;
    for (Eigen::Index j = i; j < N; ++j) {
      double& kept = at[i + j * N];
      const double was = kept;
      kept = c * was + s * row_at[j];
      row_at[j] = c * row_at[j] - s * was;
    }
  }
}

}  // namespace volcomp
