#include "host_sim/sim/truth/true_machine.hpp"

namespace volcomp::sim {

ErrorMotion TrueMachine::relative_error(std::size_t a, double q, double approach) const {
  const TrueAxis& truth = axis.at(a);
  ErrorMotion e;
  for (std::size_t c = 0; c < 6; ++c) {
    const auto channel_index = static_cast<Eigen::Index>(c);
    e(channel_index) =
        truth.channel[c].at(q, truth.lo, truth.hi) + 0.5 * approach * truth.reversal[c];
  }
  return e;
}

// Scales grow with the machine: a carriage that reads q has gone farther. Graduated circles keep
// their scale.
void TrueMachine::grow(std::size_t a, double q, ErrorMotion& body) const {
  const Joint& joint = chain.axis(a);
  if (joint.kind != JointKind::prismatic) return;
  const double warmer = temperature_offset_K + warmer_K.at(a);
  body(static_cast<Eigen::Index>(joint.axis)) += joint.sign * (q * expansion_per_K * warmer);
}

ErrorSet TrueMachine::errors(const Pose& q, const Approach& approach) const {
  ErrorSet set = zero_errors();
  for (std::size_t a = 0; a < chain.axis_count(); ++a) {
    set[a] = to_internal(relative_error(a, q[a], approach[a]), chain.axis(a), q[a],
                         Convention::relative, Side::moving);
    grow(a, q[a], set[a]);
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
