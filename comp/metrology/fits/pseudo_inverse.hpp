#pragma once
// Normal equations whose unknowns the data may not all determine.

#include <Eigen/SVD>

namespace volcomp {

template <int N>
struct LeastSquares {
  Eigen::Matrix<double, N, 1> x = Eigen::Matrix<double, N, 1>::Zero();
  int rank = 0;
};

// The shortest x that solves normal · x = right as well as can be. `normal`: symmetric, not
// negative; its directions below `void_share` of the largest count as rounding. By Jacobi
// rotations: Eigen's other decompositions of this size allocate memory on boards that have no
// alloca.
template <int N>
LeastSquares<N> pseudo_solve(const Eigen::Matrix<double, N, N>& normal,
                             const Eigen::Matrix<double, N, 1>& right, double void_share) {
  const Eigen::JacobiSVD<Eigen::Matrix<double, N, N>> svd(
      normal, Eigen::ComputeFullU | Eigen::ComputeFullV);
  LeastSquares<N> solution;
  for (Eigen::Index i = 0; i < N; ++i) {
    const double size = svd.singularValues()(i);
    if (!(size > void_share * svd.singularValues()(0))) break;  // they fall
    solution.x += svd.matrixV().col(i) * (svd.matrixU().col(i).dot(right) / size);
    ++solution.rank;
  }
  return solution;
}

}  // namespace volcomp
