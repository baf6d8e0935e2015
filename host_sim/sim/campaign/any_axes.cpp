#include "host_sim/sim/campaign/any_axes.hpp"

#include <Eigen/LU>

#include "host_sim/sim/instruments/ball_bar.hpp"
#include "host_sim/sim/instruments/laser6d.hpp"

namespace volcomp::sim {
namespace {

ErrorMotion true_value(const TrueMachine& truth, const host::MachineFile& file, std::size_t a,
                       double q, double approach) {
  Pose pose{};
  pose[a] = q;
  Approach from{};
  from[a] = approach;
  return in_file_terms(truth.errors(pose, from)[a], file, a, q);
}

host::RunsFile measure_axis(const TrueMachine& truth, const host::MachineFile& file, std::size_t a,
                            const NoiseClasses& classes, std::size_t runs,
                            const CampaignDraw& draw) {
  const host::AxisFile& axis = file.axes[a];
  const Axis along = file.chain.axis(a).axis;
  const Laser6D laser(classes, draw, static_cast<std::uint32_t>(a), {along, axis.lo, axis.hi});
  TrueMachine warmer = truth;
  warmer.warmer_K.at(a) += laser.setup().warmer_K;
  return laser.read_runs(axis.letter, axis.all_targets(), runs, [&](double q, double approach) {
    const Vec3 lever = axis.sensed.lever(along, q) + laser.setup().arm_error;
    return at_lever(true_value(warmer, file, a, q, approach), lever);
  });
}

}  // namespace

ErrorMotion in_file_terms(const ErrorMotion& internal, const host::MachineFile& file, std::size_t a,
                          double q) {
  Eigen::Matrix<double, 6, 6> forth;
  for (Eigen::Index c = 0; c < 6; ++c)
    forth.col(c) =
        to_internal(ErrorMotion::Unit(c), file.chain.axis(a), q, file.convention, file.side);
  return forth.partialPivLu().solve(internal);
}

Campaign measure_any_machine(const TrueMachine& truth, const host::MachineFile& file,
                             const NoiseClasses& classes, std::size_t runs,
                             const CampaignDraw& draw) {
  Campaign campaign{file, {}};
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    campaign.runs.push_back(measure_axis(truth, file, a, classes, runs, draw));
    host::AxisFile& axis = campaign.machine.axes[a];
    axis.reference = axis.target(axis.reference_target());
  }
  if (!file.squareness) return campaign;
  campaign.machine.squareness->measured =
      measure_squareness(truth, *file.squareness, classes, draw,
                         {file.axis_index('X'), file.axis_index('Y'), file.axis_index('Z')});
  return campaign;
}

}  // namespace volcomp::sim
