#include "comp/machine/error_motion.hpp"

#include <cmath>

#include <Eigen/LU>

#include "comp/machine/frame.hpp"

namespace volcomp {
namespace {

// 1 − cos(a) without cancellation.
double versine(double angle) {
  const double half = std::sin(0.5 * angle);
  return 2.0 * half * half;
}

// Rx Ry Rz − I, every entry a sum of products of small quantities (u, v, w = versines).
Mat3 rxryrz_minus_identity(const Vec3& angles) {
  const double sa = std::sin(angles.x());
  const double sb = std::sin(angles.y());
  const double sc = std::sin(angles.z());
  const double u = versine(angles.x());
  const double v = versine(angles.y());
  const double w = versine(angles.z());
  const double ca = 1.0 - u;
  const double cb = 1.0 - v;
  const double cc = 1.0 - w;
  Mat3 d;
  d << v * w - v - w, -cb * sc, sb,                                    //
      ca * sc + sa * sb * cc, u * w - u - w - sa * sb * sc, -sa * cb,  //
      sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, u * v - u - v;
  return d;
}

// Rx(a) Ry(b) Rz(c) − I up to second order: [e]x + N (a, b, c = EA, EB, EC).
Mat3 second_order_minus_identity(const Vec3& angles) {
  const double a = angles.x();
  const double b = angles.y();
  const double c = angles.z();
  Mat3 n;
  n << -0.5 * (b * b + c * c), 0.0, 0.0,   //
      a * b, -0.5 * (a * a + c * c), 0.0,  //
      a * c, b * c, -0.5 * (a * a + b * b);
  return cross_matrix(angles) + n;
}

// Rodrigues: sin(t)/t [e]x + (1 − cos t)/t² [e]x².
Mat3 exponential_minus_identity(const Vec3& angles) {
  const double t = angles.norm();
  const Mat3 k = cross_matrix(angles);
  if (t < 1e-8) return k + 0.5 * (k * k);  // the next term is below 1e-24
  return (std::sin(t) / t) * k + (versine(t) / (t * t)) * (k * k);
}

}  // namespace

Mat3 rotation_minus_identity(RotationModel model, const Vec3& angles) {
  switch (model) {
    case RotationModel::rxryrz:
      return rxryrz_minus_identity(angles);
    case RotationModel::exponential:
      return exponential_minus_identity(angles);
    case RotationModel::second_order:
      return second_order_minus_identity(angles);
    case RotationModel::linear:
      break;
  }
  return cross_matrix(angles);
}

Mat3 inverse_minus_identity(RotationModel model, const Vec3& angles) {
  if (model != RotationModel::linear) return rotation_minus_identity(model, angles).transpose();
  // (I + A)⁻¹ − I = −(I + A)⁻¹ A
  const Mat3 a = cross_matrix(angles);
  const Mat3 full = Mat3::Identity() + a;
  return -(full.inverse() * a);
}

ErrorMotion to_internal(const ErrorMotion& value, const Joint& joint, double q,
                        Convention convention, Side side) {
  ErrorMotion e = value;
  if (convention == Convention::relative) e *= branch_sign(joint.branch);
  const double motion = joint.sign * q;
  if (side == Side::fixed && joint.kind == JointKind::rotary) {
    const Mat3 to_moving = axis_rotation(joint.axis, motion).transpose();
    const Vec3 delta = to_moving * translation(e);
    const Vec3 epsilon = to_moving * rotation(e);
    e << delta, epsilon;
  }
  if (side == Side::base && joint.kind == JointKind::prismatic) {
    const Vec3 travel = motion * unit_vector(joint.axis);
    e.head<3>() -= travel.cross(rotation(e));
  }
  return e;
}

}  // namespace volcomp
