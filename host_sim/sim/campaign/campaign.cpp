#include "host_sim/sim/campaign/campaign.hpp"

#include <fmt/format.h>

#include "host_sim/sim/instruments/ball_bar.hpp"
#include "host_sim/sim/instruments/laser6d.hpp"

namespace volcomp::sim {
namespace {

host::RunsFile measure_axis(const TrueMachine& truth, const host::AxisFile& axis, std::size_t a,
                            const SensedPoint& sensed, const NoiseClasses& classes,
                            std::size_t runs, Random& random) {
  const Laser6D laser(truth, a, sensed, mount_laser(classes, random));
  // Not AxisFile::target(), whose last digit may differ: published figures rest on these positions.
  std::vector<double> positions;
  for (std::size_t t = 0; t < axis.targets; ++t) {
    const double s = static_cast<double>(t) / static_cast<double>(axis.targets - 1);
    positions.push_back(axis.lo + s * (axis.hi - axis.lo));
  }
  return bidirectional_runs(axis.letter, positions, runs, [&](double q, double approach) {
    return laser.read(q, approach, classes, random);
  });
}

// Mean of all runs of both directions, by target.
std::vector<ErrorMotion> mean_of(const host::RunsFile& runs) {
  std::vector<ErrorMotion> mean(runs.positions.size(), ErrorMotion::Zero());
  const auto n = static_cast<double>(runs.up.size() + runs.down.size());
  for (const auto* list : {&runs.up, &runs.down}) {
    for (const host::RunValues& run : *list) {
      for (std::size_t t = 0; t < run.size(); ++t)
        mean[t] += run[t] / n;
    }
  }
  return mean;
}

}  // namespace

host::RunsFile bidirectional_runs(
    char letter, const std::vector<double>& positions, std::size_t runs,
    const std::function<ErrorMotion(double q, double approach)>& reading) {
  host::RunsFile result;
  result.name = fmt::format("runs_{}.csv", letter);
  result.letter = letter;
  result.positions = positions;
  const auto run = [&](double approach) {
    host::RunValues values;
    for (const double q : result.positions)
      values.push_back(reading(q, approach));
    return values;
  };
  for (std::size_t r = 0; r < runs; ++r) {
    result.up.push_back(run(1.0));
    result.down.push_back(run(-1.0));
  }
  return result;
}

std::vector<LeverCheck> check_levers(const TrueMachine& truth, const host::MachineFile& file,
                                     const NoiseClasses& classes, std::size_t runs,
                                     Random& random) {
  std::vector<LeverCheck> checks;
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    const host::AxisFile& axis = file.axes[a];
    SensedPoint second = axis.sensed;
    second.at_zero += Vec3(400.0, 400.0, 400.0);
    const auto first_mean =
        mean_of(measure_axis(truth, axis, a, axis.sensed, classes, runs, random));
    const auto second_mean = mean_of(measure_axis(truth, axis, a, second, classes, runs, random));
    LeverCheck check;
    check.axis = axis.letter;
    check.status = lever_self_test(file.chain.axis(a).axis, {first_mean.data(), first_mean.size()},
                                   {second_mean.data(), second_mean.size()}, axis.sensed.at_zero,
                                   second.at_zero, check.test);
    checks.push_back(check);
  }
  return checks;
}

Campaign measure_machine(const TrueMachine& truth, const host::MachineFile& file,
                         const NoiseClasses& classes, std::size_t runs, Random& random) {
  Campaign campaign{file, {}};
  for (std::size_t a = 0; a < file.axes.size(); ++a) {
    campaign.runs.push_back(
        measure_axis(truth, file.axes[a], a, file.axes[a].sensed, classes, runs, random));
  }
  campaign.machine.squareness->measured =
      measure_squareness(truth, *file.squareness, classes, random);
  return campaign;
}

Campaign perfect_campaign(const TrueMachine& truth, const host::MachineFile& file) {
  Random unused(0);
  return measure_machine(truth, file, no_noise(), 1, unused);
}

DiagonalBox travel_box(const host::MachineFile& file) {
  return {Vec3(file.axes[0].lo, file.axes[1].lo, file.axes[2].lo),
          Vec3(file.axes[0].hi, file.axes[1].hi, file.axes[2].hi)};
}

}  // namespace volcomp::sim
