#include "comp/metrology/tables/volumetric.hpp"

#include <Eigen/LU>

namespace volcomp {
namespace {

struct Deviated {
  Vec3 ideal;      // ideal point in base
  Vec3 deviation;  // actual − ideal, base
};

// Carries a point and its deviation from the tip of a branch to base:
// e ← R_H R_J (e + δ + (R_E − I)(p + e)), p ← H J p.
Deviated carry_to_base(const MachineChain& chain, const BodyPath& path, const Pose& q,
                       const ErrorSet& errors, RotationModel model, const Vec3& tip) {
  Deviated d{tip, Vec3::Zero()};
  for (std::size_t i = path.count; i > 0; --i) {
    const std::uint8_t body = path.body[i - 1];
    const Joint& joint = chain.joint(body);
    const ErrorMotion e = chain.error_of(body, errors);
    const Vec3 displaced = d.ideal + d.deviation;
    d.deviation += translation(e) + rotation_minus_identity(model, rotation(e)) * displaced;
    const Frame step = joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]);
    d.ideal = step.apply(d.ideal);
    d.deviation = step.R * d.deviation;
  }
  return d;
}

// Carries a deviated point from base into the actual work frame: v = R_Jᵀ R_Hᵀ e − δ, e ← v +
// (R_E⁻¹ − I)(p + v).
Vec3 carry_to_work(const MachineChain& chain, const Pose& q, const ErrorSet& errors,
                   RotationModel model, Deviated d) {
  for (const std::uint8_t body : chain.work()) {
    const Joint& joint = chain.joint(body);
    const ErrorMotion e = chain.error_of(body, errors);
    const Frame step = joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]);
    d.ideal = step.apply_inverse(d.ideal);
    const Vec3 v = step.R.transpose() * d.deviation - translation(e);
    const Vec3 displaced = d.ideal + v;
    d.deviation = v + inverse_minus_identity(model, rotation(e)) * displaced;
  }
  return d.deviation;
}

Mat3 actual_rotation(const MachineChain& chain, const BodyPath& path, const Pose& q,
                     const ErrorSet& errors, RotationModel model) {
  Mat3 R = Mat3::Identity();
  for (const std::uint8_t body : path) {
    const Joint& joint = chain.joint(body);
    const Mat3 error =
        Mat3::Identity() + rotation_minus_identity(model, rotation(chain.error_of(body, errors)));
    R = R * joint_offset(joint).R * joint_motion(joint, q[joint.nc_axis]).R * error;
  }
  return R;
}

// Rotation vector of a matrix near identity, from its antisymmetric part.
Vec3 small_rotation_vector(const Mat3& R) {
  const Vec3 v = 0.5 * Vec3(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  // |v| is the sine of the angle: asin(s) / s = 1 + s²/6 + 3s⁴/40 + 15s⁶/336, below 1e-16 at 0.02
  // rad
  const double s2 = v.squaredNorm();
  return (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (15.0 / 336.0)))) * v;
}

}  // namespace

PointPair ideal_points(const MachineChain& chain, const Pose& q, const Vec3& tool_point) {
  const Vec3 in_base = chain.ideal(chain.tool(), q).apply(tool_point);
  return {tool_point, chain.ideal(chain.work(), q).apply_inverse(in_base)};
}

Vec3 squareness_translation(const MachineChain& chain, const Pose& q,
                            const DirectionErrors& directions) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < chain.axis_count(); ++a)
    sum += directions[a] * q[a];
  return sum;
}

VolumetricError exact_error(const MachineChain& chain, const Pose& q, const ErrorSet& errors,
                            const Vec3& squareness, RotationModel model, const PointPair& points) {
  Deviated tool = carry_to_base(chain, chain.tool(), q, errors, model, points.tool);
  const Deviated work = carry_to_base(chain, chain.work(), q, errors, model, points.work);
  tool.deviation += squareness;

  VolumetricError error;
  error.position_base = tool.deviation - work.deviation;
  error.position_work = carry_to_work(chain, q, errors, model, tool);

  const Mat3 Rw = chain.ideal(chain.work(), q).R;
  const Mat3 Rt = chain.ideal(chain.tool(), q).R;
  const Mat3 actual = actual_rotation(chain, chain.work(), q, errors, model).inverse() *
                      actual_rotation(chain, chain.tool(), q, errors, model);
  error.orientation_work = small_rotation_vector(actual * (Rw.transpose() * Rt).transpose());
  error.orientation_base = Rw * error.orientation_work;
  return error;
}

VolumetricError first_order_error(const MachineChain& chain, const Pose& q, const ErrorSet& errors,
                                  const Vec3& squareness, const PointPair& points) {
  VolumetricError error{squareness, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  Mat3 work_rotation = Mat3::Identity();
  for (const BodyPath* path : {&chain.tool(), &chain.work()}) {
    const bool is_work = path == &chain.work();
    const Vec3 tip = chain.ideal(*path, q).apply(is_work ? points.work : points.tool);
    const double sigma = is_work ? -1.0 : 1.0;
    Frame frame;
    for (const std::uint8_t body : *path) {
      const Joint& joint = chain.joint(body);
      frame = frame * joint_offset(joint) * joint_motion(joint, q[joint.nc_axis]);
      const ErrorMotion e = chain.error_of(body, errors);
      const Vec3 turn = frame.R * rotation(e);
      error.position_base += sigma * (frame.R * translation(e) + turn.cross(tip - frame.t));
      error.orientation_base += sigma * turn;
    }
    if (is_work) work_rotation = frame.R;
  }
  error.position_work = work_rotation.transpose() * error.position_base;
  error.orientation_work = work_rotation.transpose() * error.orientation_base;
  return error;
}

}  // namespace volcomp
