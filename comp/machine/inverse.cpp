#include "comp/machine/inverse.hpp"

#include <cmath>

#include "comp/machine/double3.hpp"

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
      const Vec3 direction = frame.R.col(static_cast<Eigen::Index>(joint.axis));
      const Vec3 column =
          joint.kind == JointKind::prismatic ? direction : crossed(direction, tip - frame.t);
      return branch_sign(joint.branch) * joint.sign * column;
    }
  }
  return Vec3::Zero();  // the axis moves tool and work together
}

namespace {

// Unit columns of the correcting axes and what completes them to three; only those in use matter.
struct Columns {
  std::array<Vec3, 3> unit;
  std::array<double, 3> scale{};
};

// |det| of three unit columns, the sine of the angle between two, 1 for one. Completes them: with
// the normal of the plane of two, least squares are the exact solution's first two coordinates.
double complete(Columns& columns, std::size_t n) {
  if (n < 2) return n == 0 ? 0.0 : 1.0;
  const Vec3 normal = crossed(columns.unit[0], columns.unit[1]);
  if (n == 3) return std::abs(normal.dot(columns.unit[2]));
  const double sine = length(normal);
  columns.unit[2] = sine > 0.0 ? Vec3(normal / sine) : normal;
  return sine;
}

// Cramer's rule.
std::array<double, 3> coordinates(const Columns& columns, std::size_t n, const Vec3& v) {
  const auto& [a, b, c] = columns.unit;
  if (n == 1) return {v.dot(a), 0.0, 0.0};
  const Vec3 bc = crossed(b, c);
  const double determinant = a.dot(bc);
  return {v.dot(bc) / determinant, v.dot(crossed(c, a)) / determinant,
          v.dot(crossed(a, b)) / determinant};
}

}  // namespace

Status motion_offset(const MachineChain& chain, const Pose& q, const Vec3& tool_point,
                     const Vec3& error_base, MotionOffset& out) {
  const MachineDescription& d = chain.description();
  const std::size_t n = d.correcting_count;
  Columns columns;
  Where where;
  where.field = "correcting";
  where.has_value = true;
  for (std::size_t c = 0; c < n; ++c) {
    columns.unit[c] = jacobian_column(chain, q, tool_point, d.correcting[c]);
    columns.scale[c] = length(columns.unit[c]);
    if (!(columns.scale[c] > 0.0)) return refuse(Reason::no_authority, where);
    columns.unit[c] /= columns.scale[c];
  }
  const double authority = complete(columns, n);
  where.value = authority;
  if (!(authority >= kMinAuthority)) return refuse(Reason::no_authority, where);

  const std::array<double, 3> solution = coordinates(columns, n, error_base);
  MotionOffset result;
  result.authority = authority;
  result.remainder = error_base;
  for (std::size_t c = 0; c < n; ++c) {
    result.remainder -= solution[c] * columns.unit[c];
    result.offset[d.correcting[c]] = -solution[c] / columns.scale[c];
  }
  out = result;
  return {};
}

}  // namespace volcomp
