#include "comp/metrology/gears/l300g.hpp"

#include <cmath>

#include "comp/machine/inverse.hpp"

namespace volcomp {
namespace {

Status refuse_value(Reason reason, double value) {
  Where where;
  where.value = value;
  where.has_value = true;
  return refuse(reason, where);
}

Body joined_to(std::uint8_t lower, JointKind kind, Axis axis, std::uint8_t nc_axis, char letter) {
  Body body;
  body.lower = lower;
  body.joint.kind = kind;
  body.joint.axis = axis;
  body.joint.nc_axis = nc_axis;
  body.joint.letter = letter;
  return body;
}

}  // namespace

MachineDescription l300g_machine(const SwingArm& arm, const L300gDatum& datum) {
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

double arm_height(const SwingArm& arm, double B) { return arm.length * std::sin(B - arm.zero); }

double arm_foreshortening(const SwingArm& arm, double B) {
  const double s = std::sin(0.5 * (B - arm.zero));
  return 2.0 * arm.length * s * s;
}

double arm_lift(const SwingArm& arm, double B) { return arm.length * std::cos(B - arm.zero); }

Status arm_angle(const SwingArm& arm, double height, double& B) {
  if (!std::isfinite(height)) return refuse_value(Reason::not_finite, height);
  if (std::abs(height) > arm.length) return refuse_value(Reason::out_of_reach, height);
  B = arm.zero + std::asin(height / arm.length);
  return {};
}

Status arm_offset(const SwingArm& arm, double B, const Vec3& error_base, ArmOffset& out) {
  const double theta = B - arm.zero;
  const double upright = std::cos(theta);
  if (!(std::abs(upright) >= kMinAuthority)) return refuse_value(Reason::no_z_authority, upright);
  ArmOffset offset;
  offset.B = -error_base.z() / (arm.length * upright);
  offset.X = -error_base.x() - arm.length * std::sin(theta) * offset.B;
  offset.Y = -error_base.y();
  out = offset;
  return {};
}

}  // namespace volcomp
