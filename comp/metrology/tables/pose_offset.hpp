#pragma once
// From an error of position and orientation to offsets of all axes that take any: the orienting
// ones hold the direction of the tool's axis as well as they can, the correcting ones hold its
// point, also against what the turns of the orienting ones do to it.

#include "comp/machine/inverse.hpp"

namespace volcomp {

struct PoseOffset {
  Pose offset{};                  // by NC axis, mm or rad; 0 for axes that take none
  Vec3 remainder = Vec3::Zero();  // position error left over, base, mm
  Vec3 tilt_remainder =
      Vec3::Zero();  // orientation error left over, its part across the tool's axis; base, rad
  double authority = 0.0;  // of the correcting axes, as MotionOffset
  double grip = 0.0;       // of the orienting axes: below kMinTurning they fade; 0 without any
};

// What an axis does to the orientation of the tool against the work: rad/rad, base; 0 for a linear
// one.
[[nodiscard]] Vec3 turning_column(const MachineChain& chain, const Pose& q, std::size_t nc_axis);

// Axis of the tool, Z of its frame, in base.
[[nodiscard]] Vec3 tool_axis(const MachineChain& chain, const Pose& q);

// At `q` where the axes really are, offsets included; they would be at q − offset. What turns do to
// the tool point is taken to second order, for the turn of an axis with little grip is ten times
// the error: half its square times the lever, and under the work the directions of the other axes,
// which turn with it. `position_base` mm, `orientation_base` rotation vector, rad. Refuses as
// motion_offset.
Status pose_offset(const MachineChain& chain, const Pose& q, const Vec3& tool_point,
                   const Vec3& position_base, const Vec3& orientation_base, PoseOffset& out);

}  // namespace volcomp
