#include "comp/geometry/inverse.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace volcomp {

Vec3 jacobian_column(const MachineChain& chain, const Pose& q, const Vec3& tool_point,
                     std::size_t nc_axis) {
  const std::uint8_t wanted = chain.body_of_axis(nc_axis);
  const Vec3 tip = chain.ideal(chain.tool(), q).apply(tool_point);
  for (const BodyPath* path : {&chain.tool(), &chain.work()}) {
    Frame frame;
    for (const std::uint8_t body : *path) {
      const Joint& joint = chain.joint(body);
      frame = frame * joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]);
      if (body != wanted) continue;
      const Vec3 direction = frame.R * unit_vector(joint.axis);
      const Vec3 column =
          joint.kind == JointKind::prismatic ? direction : direction.cross(tip - frame.t);
      return branch_sign(joint.branch) * joint.sign * column;
    }
  }
  return Vec3::Zero();  // the axis moves tool and work together
}

Status motion_offset(const MachineChain& chain, const Pose& q, const Vec3& tool_point,
                     const Vec3& error_base, MotionOffset& out) {
  const MachineDescription& d = chain.description();
  const std::size_t n = d.correcting_count;
  Mat3 J = Mat3::Zero();
  Vec3 scale = Vec3::Ones();
  Where where;
  where.field = "correcting";
  where.has_value = true;
  for (std::size_t c = 0; c < n; ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    J.col(i) = jacobian_column(chain, q, tool_point, d.correcting[c]);
    scale(i) = J.col(i).norm();
    if (!(scale(i) > 0.0)) return refuse(Reason::no_authority, where);
    J.col(i) /= scale(i);
  }
  // Gram determinant of the unit columns: det² for three axes, sin² of the angle for two, 1 for
  // one.
  Mat3 gram = Mat3::Identity();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      const auto i = static_cast<Eigen::Index>(a);
      const auto j = static_cast<Eigen::Index>(b);
      gram(i, j) = J.col(i).dot(J.col(j));
    }
  }
  const double authority = n == 0 ? 0.0 : std::sqrt(std::abs(gram.determinant()));
  where.value = authority;
  if (!(authority >= kMinAuthority)) return refuse(Reason::no_authority, where);

  // J⁺ = (JᵀJ)⁻¹Jᵀ; for three axes J⁻¹ itself, which does not square the condition.
  const Vec3 solution =
      n == 3 ? Vec3(J.inverse() * error_base) : Vec3(gram.llt().solve(J.transpose() * error_base));
  MotionOffset result;
  result.authority = authority;
  result.remainder = error_base - J * solution;
  for (std::size_t c = 0; c < n; ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    result.offset[d.correcting[c]] = -solution(i) / scale(i);
  }
  out = result;
  return {};
}

}  // namespace volcomp
