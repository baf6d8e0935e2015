#include "comp/geometry/frame.hpp"

#include <cmath>

namespace volcomp {

Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0.0, -a.z(), a.y(),  //
      a.z(), 0.0, -a.x(),   //
      -a.y(), a.x(), 0.0;
  return m;
}

Vec3 unit_vector(Axis axis) { return Vec3::Unit(static_cast<Eigen::Index>(axis)); }

Mat3 axis_rotation(Axis axis, double angle) {
  const auto i = static_cast<Eigen::Index>(axis);
  const Eigen::Index j = (i + 1) % 3;
  const Eigen::Index k = (i + 2) % 3;
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  Mat3 m = Mat3::Identity();
  m(j, j) = c;
  m(j, k) = -s;
  m(k, j) = s;
  m(k, k) = c;
  return m;
}

Frame joint_offset(const Joint& joint) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return {Eigen::Map<const RowMajor>(joint.orientation.data()),
          Eigen::Map<const Vec3>(joint.offset.data())};
}

Frame joint_motion(const Joint& joint, double q) {
  const double motion = joint.sign * q;
  switch (joint.kind) {
    case JointKind::prismatic:
      return {Mat3::Identity(), motion * unit_vector(joint.axis)};
    case JointKind::rotary:
      return {axis_rotation(joint.axis, motion), Vec3::Zero()};
    case JointKind::fixed:
      break;
  }
  return {};
}

}  // namespace volcomp
