#include "tests/oracle/rigid_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

#include "comp/metrology/fits/fold_row.hpp"

namespace volcomp {
namespace {

constexpr double kVoid = 1e-9;  // of the largest singular value

struct Targets {
  Vec3 centroid = Vec3::Zero();
  Vec3 drift = Vec3::Zero();  // mean displacement
  Vec3 spread;                // singular values of the centred positions, falling, mm
  Mat3 principal;             // their directions, columns
};

Status check(Span<const Vec3> position, Span<const Vec3> displacement) {
  Where where;
  where.count = static_cast<int>(position.size());
  if (position.size() != displacement.size()) return refuse(Reason::length_mismatch, where);
  if (position.empty()) return refuse(Reason::too_few_points, where);
  if (position.size() > kMaxTargets) return refuse(Reason::too_many_runs, where);
  for (std::size_t k = 0; k < position.size(); ++k) {
    Where at;
    at.index = static_cast<int>(k);
    if (!position[k].allFinite() || !displacement[k].allFinite())
      return refuse(Reason::not_finite, at);
  }
  return {};
}

// The singular values come from the positions themselves: squared in an inertia matrix, a line of
// targets would drown in rounding.
Targets look_at(Span<const Vec3> position, Span<const Vec3> displacement) {
  Targets t;
  const auto n = static_cast<double>(position.size());
  for (std::size_t k = 0; k < position.size(); ++k) {
    t.centroid += position[k] / n;
    t.drift += displacement[k] / n;
  }
  Mat3 triangle = Mat3::Zero();
  for (const Vec3& p : position)
    fold_row<3>(triangle, (p - t.centroid).transpose());
  const Eigen::JacobiSVD<Mat3> svd(triangle, Eigen::ComputeFullV);
  t.spread = svd.singularValues();
  t.principal = svd.matrixV();
  return t;
}

// Moments of inertia about the principal axes, mm²: what turns about an axis shows as far as
// targets are away from it.
Vec3 moments_of(const Vec3& spread) {
  const Vec3 s = spread.cwiseAbs2();
  return {s(1) + s(2), s(0) + s(2), s(0) + s(1)};
}

struct Singular {
  double largest = 0.0;
  double smallest = 0.0;
  int rank = 3;
};

// Singular values of the six unknowns, rotations in units of the rms radius.
Singular singular_values(const Vec3& moments, double n) {
  const double mean_square = 0.5 * moments.sum() / n;  // of the radius
  const double shift = std::sqrt(n);
  Singular s{shift, shift, 3};
  if (!(mean_square > 0.0)) return s;
  const Vec3 turn = (moments / mean_square).cwiseSqrt();
  s.largest = std::max(shift, turn.maxCoeff());
  s.smallest = std::min(shift, turn.minCoeff());
  for (Eigen::Index i = 0; i < 3; ++i)
    s.rank += turn(i) > kVoid * s.largest ? 1 : 0;
  return s;
}

}  // namespace

Status fit_rigid(Span<const Vec3> position, Span<const Vec3> displacement, RigidFit& out) {
  if (const Status s = check(position, displacement); !s.ok()) return s;
  const auto n = static_cast<double>(position.size());
  const Targets t = look_at(position, displacement);
  const Vec3 moments = moments_of(t.spread);
  const Singular singular = singular_values(moments, n);
  if (singular.rank < 6) {
    Where where;
    where.count = singular.rank;
    return refuse(Reason::rank_deficient, where);
  }
  Vec3 torque = Vec3::Zero();
  for (std::size_t k = 0; k < position.size(); ++k)
    torque += (position[k] - t.centroid).cross(displacement[k] - t.drift);
  const Mat3 inverse_inertia =
      t.principal * moments.cwiseInverse().asDiagonal() * t.principal.transpose();
  const Vec3 eps = inverse_inertia * torque;

  RigidFit fit;
  fit.motion << t.drift - eps.cross(t.centroid), eps;
  const Mat3 c = cross_matrix(t.centroid);  // δ = mean − ε × c = mean + c × ε
  fit.cofactors.topLeftCorner<3, 3>() = Mat3::Identity() / n + c * inverse_inertia * c.transpose();
  fit.cofactors.topRightCorner<3, 3>() = c * inverse_inertia;
  fit.cofactors.bottomLeftCorner<3, 3>() = inverse_inertia * c.transpose();
  fit.cofactors.bottomRightCorner<3, 3>() = inverse_inertia;
  double sum = 0.0;
  for (std::size_t k = 0; k < position.size(); ++k) {
    const Vec3 turned = eps.cross(position[k] - t.centroid);
    sum += (displacement[k] - t.drift - turned).squaredNorm();
  }
  fit.rms = std::sqrt(sum / std::max(1.0, 3.0 * n - 6.0));
  fit.condition = singular.largest / singular.smallest;
  out = fit;
  return {};
}

Vec3 displacement_of(const Frame& parent, const Joint& joint, double q, const Vec3& measured,
                     const Vec3& position) {
  const Frame moving = parent * joint_offset(joint) * joint_motion(joint, q);
  return moving.apply_inverse(measured) - position;
}

}  // namespace volcomp
