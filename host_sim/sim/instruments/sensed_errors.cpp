#include "host_sim/sim/instruments/sensed_errors.hpp"

#include <utility>

namespace volcomp::sim {

SensedErrors::SensedErrors(TrueMachine machine, std::size_t axis, const SensedPoint& sensed,
                           const LaserSetup& setup)
    : machine_(std::move(machine)), axis_(axis) {
  machine_.warmer_K.at(axis) += setup.warmer_K;
  // Frame origin of the axis at machine zero, then along the real lever to the sensed point.
  const Pose zero{};
  const std::uint8_t wanted = machine_.chain.body_of_axis(axis);
  Frame frame;
  const bool tool_side = machine_.chain.joint(wanted).branch == Branch::tool;
  for (const std::uint8_t body : tool_side ? machine_.chain.tool() : machine_.chain.work()) {
    frame = frame * joint_offset(machine_.chain.joint(body));
    if (body == wanted) break;
  }
  const Vec3 in_base = frame.apply(sensed.at_zero + setup.arm_error);
  point_in_tool_ = machine_.chain.ideal(machine_.chain.tool(), zero).apply_inverse(in_base);
  // A tool-carrying axis whose sensed point is fixed on the table (κ = −1) sees a lever that
  // shortens with q.
  rides_on_tool_ = !tool_side || sensed.kappa == 0;
}

ErrorMotion SensedErrors::at(double q, double approach) const {
  Pose pose{};
  pose[axis_] = q;
  Approach from{};
  from[axis_] = approach;
  Vec3 point = point_in_tool_;
  if (!rides_on_tool_) point -= q * unit_vector(machine_.chain.axis(axis_).axis);
  const VolumetricError e = machine_.error(pose, from, point);
  // The laser sees one axis move; squareness of its direction belongs to the alignment of the beam.
  const Vec3 straight = e.position_work - machine_.directions[axis_] * q;
  ErrorMotion reading;
  reading << straight, e.orientation_work;
  return reading;
}

}  // namespace volcomp::sim
