#pragma once
// Rigid frames and the elementary motions they are made of. Vectors are columns, mm and rad.

#include <Eigen/Geometry>

#include "comp/machine/double3.hpp"
#include "comp/machine/error_motion.hpp"

namespace volcomp {

// Maps coordinates of the inner frame to the outer one: p_outer = R p_inner + t.
struct Frame {
  Mat3 R = Mat3::Identity();
  Vec3 t = Vec3::Zero();

  [[nodiscard]] Vec3 apply(const Vec3& p) const { return added(turned(R, p), 1.0, t); }
  [[nodiscard]] Vec3 apply_inverse(const Vec3& p) const {
    return turned_back(R, added(p, -1.0, t));
  }
  [[nodiscard]] Frame operator*(const Frame& inner) const;
};

// The matrix of a cross product: cross_matrix(a) b = a × b.
[[nodiscard]] Mat3 cross_matrix(const Vec3& a);

[[nodiscard]] Vec3 unit_vector(Axis axis);

// Orthonormal to 1e-9, right-handed.
[[nodiscard]] bool is_rotation(const Mat3& R);

// Right-hand rotation by `angle` (rad) about a coordinate axis.
[[nodiscard]] Mat3 axis_rotation(Axis axis, double angle);

// The constant offset of a joint, and its ideal motion at NC coordinate q (mm or rad).
[[nodiscard]] Frame joint_offset(const Joint& joint);
[[nodiscard]] Frame joint_motion(const Joint& joint, double q);

}  // namespace volcomp
