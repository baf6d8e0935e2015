#pragma once
// A sphere through measured points, mm: probe calibration on a reference sphere.

#include <cstddef>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/machine/error_motion.hpp"

namespace volcomp {

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};

struct SphereFit {
  Sphere sphere;                          // least Σ(d − R)²
  Eigen::Matrix<double, 4, 4> cofactors;  // (JᵀJ)⁻¹, order x, y, z, radius: covariance over σ²
  double rms = 0.0;                       // residuals over max(1, n − 4) degrees of freedom, mm
  double largest = 0.0;                   // residual of largest magnitude, signed, mm
  std::size_t worst = 0;                  // its point
};

// Refused, in this order: too_few_points (fewer than 4), not_finite (index), coincident,
// rank_deficient (count = rank: 2 for points on a line, 3 for points in a plane or on a circle).
Status fit_sphere(Span<const Vec3> points, SphereFit& out);

}  // namespace volcomp
