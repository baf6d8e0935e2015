#pragma once
// Six joints as libraries of kinematics carry a point along them, with the vectors of the
// processor.

#include <array>

namespace volcomp::bench {

// Six 4×4 products of Eigen and the product with a point; coordinates of the point.
[[nodiscard]] std::array<float, 3> six_products_float(float q);
[[nodiscard]] std::array<double, 3> six_products_double(double q);

// KDL (liborocos-kdl-dev), or what says that the build did not find it.
[[nodiscard]] bool has_kdl();
// Six frames applied to a vector, and the position of a chain of six joints by
// ChainFkSolverPos_recursive.
[[nodiscard]] std::array<double, 3> six_kdl_frames(double q);
[[nodiscard]] std::array<double, 3> six_kdl_joints(double q);

}  // namespace volcomp::bench
