#include "host_sim/host/measure/identify/chain_geometry.hpp"

#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace volcomp::host::identify {
namespace {

Frame error_frame(const ErrorMotion& e) {
  return {Mat3::Identity() + rotation_minus_identity(RotationModel::rxryrz, rotation(e)),
          translation(e)};
}

void walk(const MachineChain& chain, const BodyPath& path, const Pose& q, double side,
          ChainGeometry& g, Frame& tip) {
  for (const std::uint8_t body : path) {
    const Joint& joint = chain.joint(body);
    tip = tip * joint_offset(joint);
    if (!joint.moves()) continue;
    tip = tip * joint_motion(joint, q[joint.nc_axis]);
    g.joint[joint.nc_axis] = tip;
    g.side[joint.nc_axis] = side;
    g.sense[joint.nc_axis] = joint.sign;
  }
}

Frame actual_tip(const MachineChain& chain, const BodyPath& path, const Pose& q,
                 const ErrorSet& errors) {
  Frame tip;
  for (const std::uint8_t body : path) {
    const Joint& joint = chain.joint(body);
    tip = tip * joint_offset(joint);
    if (joint.moves()) tip = tip * joint_motion(joint, q[joint.nc_axis]);
    tip = tip * error_frame(chain.error_of(body, errors));
  }
  return tip;
}

}  // namespace

ChainGeometry ideal_geometry(const MachineChain& chain, const Pose& q) {
  ChainGeometry g;
  walk(chain, chain.work(), q, branch_sign(Branch::work), g, g.work);
  walk(chain, chain.tool(), q, branch_sign(Branch::tool), g, g.tool);
  return g;
}

TipFrames actual_tips(const MachineChain& chain, const Pose& q, const ErrorSet& errors) {
  return {actual_tip(chain, chain.work(), q, errors), actual_tip(chain, chain.tool(), q, errors)};
}

ErrorEffect point_effect(const ChainGeometry& g, std::size_t axis, const Vec3& point) {
  const Frame& joint = g.joint.at(axis);
  ErrorEffect effect;
  effect.leftCols<3>() = g.side.at(axis) * joint.R;
  effect.rightCols<3>() = -g.side.at(axis) * cross_matrix(point - joint.t) * joint.R;
  return effect;
}

ErrorEffect turn_effect(const ChainGeometry& g, std::size_t axis) {
  ErrorEffect effect = ErrorEffect::Zero();
  effect.rightCols<3>() = g.side.at(axis) * g.joint.at(axis).R;
  return effect;
}

Vec3 slide_in_work(const MachineChain& chain, const ChainGeometry& g, std::size_t axis) {
  const Vec3 along = g.joint.at(axis).R * unit_vector(chain.axis(axis).axis);
  return g.side.at(axis) * g.sense.at(axis) * (g.work.R.transpose() * along);
}

bool move_by(const MachineChain& chain, const ChainGeometry& g, const Vec3& way, Pose& q) {
  std::vector<std::size_t> slides;
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    if (chain.axis(a).kind == JointKind::prismatic) slides.push_back(a);
  if (slides.size() != 3) return false;
  Mat3 columns;
  for (std::size_t k = 0; k < 3; ++k)
    columns.col(static_cast<Eigen::Index>(k)) = slide_in_work(chain, g, slides[k]);
  const Eigen::FullPivLU<Mat3> solver(columns);
  if (!solver.isInvertible()) return false;
  const Vec3 step = solver.solve(way);
  for (std::size_t k = 0; k < 3; ++k)
    q.at(slides[k]) += step(static_cast<Eigen::Index>(k));
  return true;
}

Mat3 exponential(const Vec3& turn) {
  const double angle = turn.norm();
  if (!(angle > 0.0)) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

}  // namespace volcomp::host::identify
