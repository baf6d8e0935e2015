#include "host_sim/experiments/l300g/printed_procedure.hpp"

#include <vector>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::l300g {
namespace {

constexpr double kPrintedStart_mm = 100.0;  // x₀ of the paper's Table 2

std::vector<ErrorMotion> errors_of_axis(const sim::TrueMachine& truth,
                                        const host::MachineFile& file, std::size_t axis) {
  std::vector<ErrorMotion> errors;
  for (const double q : file.axes[axis].all_targets()) {
    Pose pose{};
    pose.at(axis) = q;
    errors.push_back(truth.errors(pose, {}).at(axis));
  }
  return errors;
}

std::vector<double> own_readings(const Joint& joint, const std::vector<ErrorMotion>& errors) {
  const auto channel =
      static_cast<Eigen::Index>(joint.axis) + (joint.kind == JointKind::rotary ? 3 : 0);
  std::vector<double> readings;
  readings.reserve(errors.size());
  for (const ErrorMotion& e : errors)
    readings.push_back(e(channel));
  return readings;
}

}  // namespace

PrintedProcedure printed_procedure(const sim::TrueMachine& truth, const host::MachineFile& file) {
  PrintedProcedure printed;
  for (std::size_t a = 0; a < printed.own.size(); ++a) {
    const std::vector<double> readings =
        own_readings(file.chain.axis(a), errors_of_axis(truth, file, a));
    host::require(reading_figures(readings, printed.own[a]), "readings");
    // The rows of eq. 18 differ in nothing but their right sides.
    if (a == 0) host::require(printed_x_solution(readings, kPrintedStart_mm, printed.x), "eq. 18");
  }
  return printed;
}

ErrorSet mean_errors(const sim::TrueMachine& truth, const host::MachineFile& file) {
  ErrorSet mean = zero_errors();
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    const std::vector<ErrorMotion> errors = errors_of_axis(truth, file, a);
    for (const ErrorMotion& e : errors)
      mean.at(a) += e / static_cast<double>(errors.size());
  }
  return mean;
}

}  // namespace volcomp::l300g
