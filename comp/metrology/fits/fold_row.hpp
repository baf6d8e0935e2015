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
    const double length = std::hypot(triangle(i, i), row(i));
    if (!(length > 0.0)) continue;
    const double c = triangle(i, i) / length;
    const double s = row(i) / length;
    const Eigen::Matrix<double, 1, N> kept = triangle.row(i);
    triangle.row(i) = c * kept + s * row;
    row = c * row - s * kept;
  }
}

}  // namespace volcomp
