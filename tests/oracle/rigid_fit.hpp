#pragma once
// The six error motions of one joint from targets it carries: rigid least squares.
//
// d_k = δ + ε × p_k, d_k measured displacement and p_k nominal position of target k in the moving
// frame. Centred, the two unknowns separate: δ at the centroid is the mean of d, and ε follows from
// the inertia of the targets, whose principal axes show what they can and cannot determine.

#include "comp/core/span.hpp"
#include "comp/core/status.hpp"
#include "comp/machine/frame.hpp"

namespace volcomp {

inline constexpr std::size_t kMaxTargets = 64;

struct RigidFit {
  ErrorMotion motion = ErrorMotion::Zero();  // at the origin of the moving frame, mm and rad
  Eigen::Matrix<double, 6, 6> cofactors;     // covariance of `motion` over σ²
  double rms = 0.0;        // residuals over max(1, 3n − 6) degrees of freedom, mm
  double condition = 0.0;  // largest over smallest singular value, centred, lengths in rms radii
};

// `position` and `displacement`: as many of each, at most kMaxTargets, mm. Refused:
// length_mismatch, too_few_points (none) or too_many_runs, not_finite (index), rank_deficient
// (count = rank, 3 for one place, 5 for targets on a line).
Status fit_rigid(Span<const Vec3> position, Span<const Vec3> displacement, RigidFit& out);

// Displacement of a target in the moving frame: the joint stands at q (mm or rad) and hangs on
// `parent`; `measured` in the outer frame of `parent`, `position` in the moving frame.
[[nodiscard]] Vec3 displacement_of(const Frame& parent, const Joint& joint, double q,
                                   const Vec3& measured, const Vec3& position);

}  // namespace volcomp
