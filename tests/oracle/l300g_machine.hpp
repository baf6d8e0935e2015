#pragma once
// The chain of the L300G written down by hand, and its arm to first order, beside the machine file
// and the general inverse.

#include <cmath>

#include "comp/machine/inverse.hpp"
#include "comp/metrology/gears/l300g.hpp"

namespace volcomp::test {

inline Body joined_to(std::uint8_t lower, JointKind kind, Axis axis, std::uint8_t nc_axis,
                      char letter) {
  Body body;
  body.lower = lower;
  body.joint.kind = kind;
  body.joint.axis = axis;
  body.joint.nc_axis = nc_axis;
  body.joint.letter = letter;
  return body;
}

inline MachineDescription l300g_machine(const SwingArm& arm, const L300gDatum& datum) {
  MachineDescription d;
  d.body_count = 5;
  d.body[1] = joined_to(1, JointKind::prismatic, Axis::x, 0, 'X');
  d.body[1].joint.offset = {arm.length - datum.x, -datum.y, 0.0};
  d.body[2] = joined_to(2, JointKind::prismatic, Axis::y, 1, 'Y');
  d.body[3] = joined_to(3, JointKind::rotary, Axis::y, 2, 'B');
  const Mat3 back = axis_rotation(Axis::y, -arm.zero);
  for (Eigen::Index i = 0; i < 9; ++i)
    d.body[3].joint.orientation[static_cast<std::size_t>(i)] = back(i / 3, i % 3);
  d.body[4] = joined_to(1, JointKind::rotary, Axis::x, 3, 'A');
  d.tool_body = 4;
  d.work_body = 5;
  d.tool_point = {-arm.length, 0.0, 0.0};
  d.correcting = {0, 1, 2};
  d.correcting_count = 3;
  return d;
}

// Height of the ball centre above the axis of A, mm.
inline double arm_height(const SwingArm& arm, double B) {
  return arm.length * std::sin(B - arm.zero);
}

struct ArmOffset {
  double X = 0.0;  // mm
  double Y = 0.0;  // mm
  double B = 0.0;  // rad
};

// What X, Y and B have to move to cancel a position error in base, to first order. Refused where
// the arm is within 6° of upright: no_z_authority (value = cosine).
inline Status arm_offset(const SwingArm& arm, double B, const Vec3& error_base, ArmOffset& out) {
  const double theta = B - arm.zero;
  const double upright = std::cos(theta);
  if (!(std::abs(upright) >= kMinAuthority)) {
    Where where;
    where.value = upright;
    where.has_value = true;
    return refuse(Reason::no_z_authority, where);
  }
  out.B = -error_base.z() / (arm.length * upright);
  out.X = -error_base.x() - arm.length * std::sin(theta) * out.B;
  out.Y = -error_base.y();
  return {};
}

}  // namespace volcomp::test
