#include "host_sim/sim/truth/average_line.hpp"

#include <Eigen/LU>

namespace volcomp::sim {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

// From the fixed frame of a rotary axis into the one that has turned.
Mat6 turned_into(const Joint& joint, double q) {
  Mat6 turned;
  for (Eigen::Index c = 0; c < 6; ++c)
    turned.col(c) = to_internal(ErrorMotion::Unit(c), joint, q, Convention::body, Side::fixed);
  return turned;
}

}  // namespace

ErrorMotion error_of(const AverageLine& line, const Joint& joint, double q) {
  return to_internal(line.fixed, joint, q, Convention::body, Side::fixed) + line.moving;
}

AverageLine average_line(const host::AxisFile& axis, const Joint& joint,
                         const std::vector<ErrorMotion>& error) {
  const std::size_t reference = axis.reference_target();
  if (joint.kind != JointKind::rotary) return {ErrorMotion::Zero(), error[reference]};
  // The last target of a full turn is the first again.
  const std::size_t count = error.size() - (axis.full_turn() ? 1 : 0);
  Mat6 mean_turn = Mat6::Zero();
  ErrorMotion mean = ErrorMotion::Zero();
  for (std::size_t t = 0; t < count; ++t) {
    const Mat6 back = turned_into(joint, axis.target(t)).transpose();
    mean_turn += back / static_cast<double>(count);
    mean += back * error[t] / static_cast<double>(count);
  }
  const Mat6 at_reference = turned_into(joint, axis.target(reference));
  Mat6 matrix = Mat6::Identity() - mean_turn * at_reference;
  ErrorMotion right = mean - mean_turn * error[reference];
  // Along and about the axis there is no place: all that is constant there is where it counts from.
  for (const Eigen::Index own : {Eigen::Index{0}, Eigen::Index{3}}) {
    const Eigen::Index c = own + static_cast<Eigen::Index>(joint.axis);
    matrix.row(c) = Eigen::Matrix<double, 1, 6>::Unit(c);
    right(c) = 0.0;
  }
  AverageLine line;
  line.fixed = matrix.partialPivLu().solve(right);
  line.moving = error[reference] - at_reference * line.fixed;
  return line;
}

AverageLine true_line(const TrueMachine& truth, const host::MachineFile& file, std::size_t a) {
  std::vector<ErrorMotion> error;
  for (const double q : file.axes[a].all_targets()) {
    Pose pose{};
    pose[a] = q;
    error.push_back(truth.errors(pose, {})[a]);
  }
  return average_line(file.axes[a], file.chain.axis(a), error);
}

TrueMachine counted_from_references(TrueMachine truth, const host::MachineFile& file) {
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    // Channels are relative values.
    const ErrorMotion relative =
        branch_sign(file.chain.axis(a).branch) * true_line(truth, file, a).moving;
    for (std::size_t c = 0; c < 6; ++c)
      truth.axis[a].channel[c].constant -= relative(static_cast<Eigen::Index>(c));
  }
  return truth;
}

}  // namespace volcomp::sim
