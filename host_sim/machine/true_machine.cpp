#include "host_sim/machine/true_machine.hpp"

namespace volcomp::sim {

ErrorMotion TrueMachine::relative_error(std::size_t a, double q, double approach) const {
  const TrueAxis& truth = axis.at(a);
  ErrorMotion e;
  for (std::size_t c = 0; c < 6; ++c) {
    const auto channel_index = static_cast<Eigen::Index>(c);
    e(channel_index) =
        truth.channel[c].at(q, truth.lo, truth.hi) + 0.5 * approach * truth.reversal[c];
  }
  // Scales grow with the machine: the position error along the axis. Graduated circles do not care.
  const Joint& joint = chain.axis(a);
  if (joint.kind == JointKind::prismatic)
    e(static_cast<Eigen::Index>(joint.axis)) += q * expansion_per_K * temperature_offset_K;
  return e;
}

ErrorSet TrueMachine::errors(const Pose& q, const Approach& approach) const {
  ErrorSet set = zero_errors();
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    set[a] = to_internal(relative_error(a, q[a], approach[a]), chain.axis(a), q[a],
                         Convention::relative, Side::moving);
  }
  return set;
}

VolumetricError TrueMachine::error(const Pose& q, const Approach& approach,
                                   const Vec3& tool_point) const {
  const Vec3 squareness = squareness_translation(chain, q, directions);
  return exact_error(chain, q, errors(q, approach), squareness, RotationModel::rxryrz,
                     ideal_points(chain, q, tool_point));
}

}  // namespace volcomp::sim
