#include "comp/metrology/tables/pose_offset.hpp"

#include <algorithm>
#include <cmath>

#include "comp/machine/double3.hpp"
#include "comp/machine/tilt.hpp"

namespace volcomp {

Vec3 turning_column(const MachineChain& chain, const Pose& q, std::size_t nc_axis) {
  const std::uint8_t wanted = chain.body_of_axis(nc_axis);
  if (chain.axis(nc_axis).kind != JointKind::rotary) return Vec3::Zero();
  for (const BodyPath* path : {&chain.tool(), &chain.work()}) {
    Frame frame;
    for (const std::uint8_t body : *path) {
      const Joint& joint = chain.joint(body);
      frame = frame * joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]);
      if (body != wanted) continue;
      const Vec3 direction = frame.R.col(static_cast<Eigen::Index>(joint.axis));
      return branch_sign(joint.branch) * joint.sign * direction;
    }
  }
  return Vec3::Zero();  // the axis moves tool and work together
}

Vec3 tool_axis(const MachineChain& chain, const Pose& q) {
  return chain.ideal(chain.tool(), q).R.col(2);
}

Status pose_offset(const MachineChain& chain, const Pose& q, const Vec3& tool_point,
                   const Vec3& position_base, const Vec3& orientation_base, PoseOffset& out) {
  const MachineDescription& d = chain.description();
  const Vec3 tool = tool_axis(chain, q);
  const Vec3 off = crossed(orientation_base, tool);
  std::array<Vec3, kMaxOrienting> turn{Vec3::Zero(), Vec3::Zero()};
  std::array<Vec3, kMaxOrienting> across{Vec3::Zero(), Vec3::Zero()};
  for (std::size_t o = 0; o < d.orienting_count; ++o) {
    turn[o] = turning_column(chain, q, d.orienting[o]);
    across[o] = crossed(turn[o], tool);
  }
  TiltEquations<double> e;
  e.t11 = across[0].dot(across[0]);
  e.t12 = across[0].dot(across[1]);
  e.b1 = across[0].dot(off);
  if (d.orienting_count == kMaxOrienting) {
    e.t22 = across[1].dot(across[1]);
    e.b2 = across[1].dot(off);
  }
  const std::array<double, kMaxOrienting> excess = solve_tilt(e);

  PoseOffset result;
  if (d.orienting_count != 0) result.grip = std::sqrt(std::max(0.0, e.t11 * e.t22 - e.t12 * e.t12));
  Vec3 position = position_base;
  Vec3 orientation = orientation_base;
  for (std::size_t o = 0; o < d.orienting_count; ++o) {
    result.offset[d.orienting[o]] = -excess[o];
    const Vec3 shift = jacobian_column(chain, q, tool_point, d.orienting[o]);
    position -= excess[o] * (shift + 0.5 * excess[o] * crossed(turn[o], shift));
    if (chain.axis(d.orienting[o]).branch == Branch::work)
      position -= excess[o] * crossed(turn[o], position);
    orientation -= excess[o] * turn[o];
  }
  MotionOffset motion;
  if (const Status s = motion_offset(chain, q, tool_point, position, motion); !s.ok()) return s;
  for (std::size_t c = 0; c < d.correcting_count; ++c)
    result.offset[d.correcting[c]] = motion.offset[d.correcting[c]];
  result.remainder = motion.remainder;
  result.tilt_remainder = orientation - orientation.dot(tool) * tool;
  result.authority = motion.authority;
  out = result;
  return {};
}

}  // namespace volcomp
