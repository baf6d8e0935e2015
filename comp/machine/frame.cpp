#include "comp/machine/frame.hpp"

#include <Eigen/Geometry>

#include "comp/machine/fine_trig.hpp"

namespace volcomp {

Frame Frame::operator*(const Frame& inner) const { return {product(R, inner.R), apply(inner.t)}; }

Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0.0, -a.z(), a.y(),  //
      a.z(), 0.0, -a.x(),   //
      -a.y(), a.x(), 0.0;
  return m;
}

Vec3 unit_vector(Axis axis) { return Vec3::Unit(static_cast<Eigen::Index>(axis)); }

bool is_rotation(const Mat3& R) {
  constexpr double kOrthonormal = 1e-9;
  for (int k = 0; k < 3; ++k) {
    const Vec3 defect = added(turned_back(R, R.col(k)), -1.0, Vec3::Unit(k));
    if (!(length(defect) <= kOrthonormal)) return false;
  }
  return dot_of(R.data() + 6, 1, crossed(R.col(0), R.col(1))) > 0.0;
}

Mat3 axis_rotation(Axis axis, double angle) {
  const auto i = static_cast<Eigen::Index>(axis);
  const Eigen::Index j = (i + 1) % 3;
  const Eigen::Index k = (i + 2) % 3;
  const FineSineCosine t = fine_sine_cosine_rad(angle);
  Mat3 m = Mat3::Identity();
  m(j, j) = t.cosine;
  m(j, k) = -t.sine;
  m(k, j) = t.sine;
  m(k, k) = t.cosine;
  return m;
}

Frame joint_offset(const Joint& joint) {
  Frame offset;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto i = static_cast<Eigen::Index>(row);
    for (std::size_t column = 0; column < 3; ++column)
      offset.R(i, static_cast<Eigen::Index>(column)) = joint.orientation[3 * row + column];
    offset.t(i) = joint.offset[row];
  }
  return offset;
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
