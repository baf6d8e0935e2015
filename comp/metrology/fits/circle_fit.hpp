#pragma once
// Circles through measured points of a plane, mm: probe calibration on a mandrel.
//
// The geometric fit is the result; the algebraic ones start it and are what textbooks print. Points
// are centred first: the normal equations printed in the paper of docs/papers/l300g.md are badly
// conditioned far from the origin.

#include <cstddef>

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/machine/error_motion.hpp"

namespace volcomp {

struct Circle {
  double y = 0.0;  // centre
  double z = 0.0;
  double radius = 0.0;
};

struct CircleFit {
  Circle kasa;       // least Σ(d² − R²)²
  Circle pratt;      // nearly unbiased algebraic fits, by Newton's method from 0
  Circle taubin;     //
  Circle geometric;  // least Σ(d − R)²
  Mat3 cofactors;    // (JᵀJ)⁻¹ of the geometric fit, order y, z, radius: covariance over σ²
  double rms = 0.0;  // residuals of the geometric fit over max(1, n − 3) degrees of freedom, mm
  double largest = 0.0;   // residual of largest magnitude, signed, mm
  std::size_t worst = 0;  // its point
};

// `y` and `z`: coordinates of the same points. Refused, in this order: length_mismatch,
// too_few_points (fewer than 3), not_finite (index), coincident, collinear.
Status fit_circle(Span<const double> y, Span<const double> z, CircleFit& out);

}  // namespace volcomp
