#include "host_sim/experiments/l300g/printed_procedure.hpp"

#include <vector>

#include "host_sim/host/io/user_error.hpp"

namespace volcomp::l300g {
namespace {

constexpr double kPrintedStart_mm = 100.0;  // x₀ of the paper's Table 2

std::vector<double> own_readings(const Joint& joint, const std::vector<ErrorMotion>& truth) {
  const auto channel =
      static_cast<Eigen::Index>(joint.axis) + (joint.kind == JointKind::rotary ? 3 : 0);
  std::vector<double> readings;
  readings.reserve(truth.size());
  for (const ErrorMotion& e : truth)
    readings.push_back(e(channel));
  return readings;
}

}  // namespace

PrintedProcedure printed_procedure(const sim::Identification& found,
                                   const host::MachineFile& file) {
  PrintedProcedure printed;
  for (std::size_t a = 0; a < printed.own.size(); ++a) {
    const std::vector<double> readings = own_readings(file.chain.axis(a), found.truth.at(a));
    host::require(reading_figures(readings, printed.own[a]), "readings");
    // The rows of eq. 18 differ in nothing but their right sides.
    if (a == 0) host::require(printed_x_solution(readings, kPrintedStart_mm, printed.x), "eq. 18");
  }
  return printed;
}

}  // namespace volcomp::l300g
