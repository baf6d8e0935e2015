#include "tests/oracle/axis_identification.hpp"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace volcomp {
namespace {

constexpr double kLargest_mm = 1.0;
constexpr double kOutlier = 4.0;  // standard deviations

Status look_for_outliers(Span<const Vec3> position, Span<const Vec3> displacement, double sigma,
                         const RigidFit& fit) {
  for (std::size_t k = 0; k < position.size() && sigma > 0.0; ++k) {
    const Vec3 fitted = translation(fit.motion) + rotation(fit.motion).cross(position[k]);
    Where where;
    where.index = static_cast<int>(k);
    where.has_value = true;
    where.value = (displacement[k] - fitted).norm();
    if (!(where.value <= kOutlier * sigma)) return refuse(Reason::outlier, where);
  }
  return {};
}

// The fit of one node.
Status fit_node(const Frame& parent, const Joint& joint, const AxisTargets& t, std::size_t node,
                RigidFit& fit) {
  const std::size_t count = t.position.size();
  std::array<Vec3, kMaxTargets> displacement;
  for (std::size_t k = 0; k < count; ++k) {
    displacement[k] =
        displacement_of(parent, joint, t.nodes[node], t.measured[node * count + k], t.position[k]);
    Where where;
    where.target = static_cast<int>(node);
    where.index = static_cast<int>(k);
    where.has_value = true;
    where.value = displacement[k].norm();
    if (where.value > kLargest_mm) return refuse(Reason::unit_suspected, where);
  }
  const Span<const Vec3> displaced{displacement.data(), count};
  Status status = fit_rigid(t.position, displaced, fit);
  if (status.ok()) status = look_for_outliers(t.position, displaced, t.sigma, fit);
  status.where.target = static_cast<int>(node);
  return status;
}

}  // namespace

Status identify_axis(const Frame& parent, const Joint& joint, const AxisTargets& targets,
                     Span<ErrorMotion> motion) {
  const std::size_t count = targets.position.size();
  if (targets.measured.size() != targets.nodes.size() * count ||
      motion.size() != targets.nodes.size() || count > kMaxTargets)
    return refuse(Reason::length_mismatch);
  RigidFit fit;  // every node is tried before the first one is written
  for (std::size_t node = 0; node < motion.size(); ++node) {
    if (const Status s = fit_node(parent, joint, targets, node, fit); !s.ok()) return s;
  }
  for (std::size_t node = 0; node < motion.size(); ++node) {
    static_cast<void>(fit_node(parent, joint, targets, node, fit));
    motion[node] = fit.motion;
  }
  return {};
}

Status check_order(const MachineChain& chain, std::size_t nc_axis, std::uint32_t identified,
                   const Pose& q, const Pose& reference) {
  const std::uint8_t wanted = chain.body_of_axis(nc_axis);
  for (const BodyPath* path : {&chain.tool(), &chain.work()}) {
    Where first;
    for (const std::uint8_t body : *path) {
      if (body == wanted) {
        if (first.axis != '\0') return refuse(Reason::parent_not_identified, first);
        return {};
      }
      const Joint& joint = chain.joint(body);
      if (!joint.moves() || (identified >> joint.nc_axis & 1U) != 0) continue;
      const double away = q[joint.nc_axis] - reference[joint.nc_axis];
      if (std::abs(away) > 0.0 && first.axis == '\0') first.axis = joint.letter;
    }
  }
  return {};
}

Frame actual_frame(const MachineChain& chain, const BodyPath& path, std::size_t count,
                   const Pose& q, const ErrorSet& errors) {
  Frame frame;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t body = path.body[i];
    const Joint& joint = chain.joint(body);
    const ErrorMotion e = chain.error_of(body, errors);
    const Mat3 turned =
        Mat3::Identity() + rotation_minus_identity(RotationModel::rxryrz, rotation(e));
    frame = frame * joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]) *
            Frame{turned, translation(e)};
  }
  return frame;
}

}  // namespace volcomp
