#include "host_sim/sim/campaign/campaign.hpp"

#include "host_sim/sim/instruments/ball_bar.hpp"
#include "host_sim/sim/instruments/laser6d.hpp"
#include "host_sim/sim/instruments/sensed_errors.hpp"

namespace volcomp::sim {
namespace {

host::RunsFile measure_axis(const TrueMachine& truth, const host::AxisFile& axis, std::size_t a,
                            const SensedPoint& sensed, const Laser6D& laser, std::size_t runs) {
  const SensedErrors errors(truth, a, sensed, laser.setup());
  // Not AxisFile::target(), whose last digit may differ: published figures rest on these positions.
  std::vector<double> positions;
  for (std::size_t t = 0; t < axis.targets; ++t) {
    const double s = static_cast<double>(t) / static_cast<double>(axis.targets - 1);
    positions.push_back(axis.lo + s * (axis.hi - axis.lo));
  }
  return laser.read_runs(axis.letter, positions, runs,
                         [&](double q, double approach) { return errors.at(q, approach); });
}

}  // namespace

std::vector<LeverCheck> check_levers(const TrueMachine& truth, const host::MachineFile& file,
                                     const NoiseClasses& classes, std::size_t runs,
                                     const CampaignDraw& draw) {
  std::vector<LeverCheck> checks;
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    const host::AxisFile& axis = file.axes[a];
    SensedPoint second = axis.sensed;
    second.at_zero += Vec3(400.0, 400.0, 400.0);
    const LaserPlace place{file.chain.axis(a).axis, axis.lo, axis.hi};
    const auto number = static_cast<std::uint32_t>(a);
    const auto mean_at = [&](const SensedPoint& sensed, std::uint32_t set_up) {
      const Laser6D laser(classes, draw, set_up, place);
      return mean_of_runs(measure_axis(truth, axis, a, sensed, laser, runs));
    };
    const auto first_mean = mean_at(axis.sensed, number);
    const auto second_mean = mean_at(second, number + kSecondSetUp);
    LeverCheck check;
    check.axis = axis.letter;
    check.status = lever_self_test(place.axis, {first_mean.data(), first_mean.size()},
                                   {second_mean.data(), second_mean.size()}, axis.sensed.at_zero,
                                   second.at_zero, check.test);
    checks.push_back(check);
  }
  return checks;
}

Campaign measure_machine(const TrueMachine& truth, const host::MachineFile& file,
                         const NoiseClasses& classes, std::size_t runs, const CampaignDraw& draw) {
  Campaign campaign{file, {}};
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    const host::AxisFile& axis = file.axes[a];
    const Laser6D laser(classes, draw, static_cast<std::uint32_t>(a),
                        {file.chain.axis(a).axis, axis.lo, axis.hi});
    campaign.runs.push_back(measure_axis(truth, axis, a, axis.sensed, laser, runs));
  }
  campaign.machine.squareness->measured =
      measure_squareness(truth, *file.squareness, classes, draw);
  return campaign;
}

Campaign perfect_campaign(const TrueMachine& truth, const host::MachineFile& file) {
  return measure_machine(truth, file, no_noise(), 1, {});
}

DiagonalBox travel_box(const host::MachineFile& file) {
  return {Vec3(file.axes[0].lo, file.axes[1].lo, file.axes[2].lo),
          Vec3(file.axes[0].hi, file.axes[1].hi, file.axes[2].hi)};
}

}  // namespace volcomp::sim
