#include "comp/metrology/tables/left_error.hpp"

#include <Eigen/LU>

namespace volcomp {
namespace {

Frame actual_branch(const MachineChain& chain, const BodyPath& path, const Pose& q,
                    const ErrorSet& errors, RotationModel model) {
  Frame frame;
  for (const std::uint8_t body : path) {
    const Joint& joint = chain.joint(body);
    const ErrorMotion e = chain.error_of(body, errors);
    const Frame motion{Mat3::Identity() + rotation_minus_identity(model, rotation(e)),
                       translation(e)};
    frame = frame * joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]) * motion;
  }
  return frame;
}

// work⁻¹ tool
Frame relative(const Frame& work, const Frame& tool) {
  return {product(work.R.transpose(), tool.R), work.apply_inverse(tool.t)};
}

}  // namespace

Frame tool_in_work(const MachineChain& chain, const Pose& q) {
  return relative(chain.ideal(chain.work(), q), chain.ideal(chain.tool(), q));
}

Frame actual_tool_in_work(const MachineChain& chain, const Pose& q, const ErrorSet& errors,
                          RotationModel model) {
  const Frame work = actual_branch(chain, chain.work(), q, errors, model);
  const Frame tool = actual_branch(chain, chain.tool(), q, errors, model);
  if (model != RotationModel::linear) return relative(work, tool);
  const Mat3 back = work.R.inverse();
  return {product(back, tool.R), turned(back, added(tool.t, -1.0, work.t))};
}

LeftError left_error(const MachineChain& chain, const Pose& q, const ErrorSet& errors) {
  const Vec3 origin = Vec3::Zero();
  const PointPair at_origin{tool_in_work(chain, q).apply_inverse(origin), origin};
  const VolumetricError e = first_order_error(chain, q, errors, origin, at_origin);
  return {e.position_work, e.orientation_work};
}

SensitivityRows left_error_sensitivity(const MachineChain& chain, const Pose& q, const Vec3& P,
                                       const Vec3& n) {
  SensitivityRows rows;
  rows.fill(SensitivityRow::Zero());
  const Frame work = chain.ideal(chain.work(), q);
  const Vec3 P_base = work.apply(P);
  const Vec3 n_base = turned(work.R, n);
  for (const BodyPath* path : {&chain.tool(), &chain.work()}) {
    Frame frame;
    for (const std::uint8_t body : *path) {
      const Joint& joint = chain.joint(body);
      frame = frame * joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]);
      if (!joint.moves()) continue;
      const double sigma = branch_sign(joint.branch);
      const Vec3 arm = added(P_base, -1.0, frame.t);
      rows[joint.nc_axis] << sigma * turned_back(frame.R, n_base),
          sigma * turned_back(frame.R, arm.cross(n_base));
    }
  }
  return rows;
}

}  // namespace volcomp
