#include "host_sim/sim/campaign/measured_positions.hpp"

namespace volcomp::sim {
namespace {

constexpr double kFeed_mm_s = 10000.0 / 60.0;
constexpr double kRapid_mm_s = 400.0;
constexpr double kOverrun_mm = 2.0;  // so that the first target is approached like all others

// Deviation along the axis at every target, approached upwards or downwards, mm.
std::vector<double> pass(MotionCell& cell, const std::vector<Vec3>& target, Eigen::Index axis,
                         bool up) {
  std::vector<double> deviation(target.size());
  const Vec3 step = Vec3::Unit(axis) * (up ? kOverrun_mm : -kOverrun_mm);
  cell.move_to((up ? target.front() : target.back()) - step, kRapid_mm_s);
  for (std::size_t i = 0; i < target.size(); ++i) {
    const std::size_t t = up ? i : target.size() - 1 - i;
    cell.move_to(target[t], kFeed_mm_s);
    deviation[t] = cell.deviation_mm()(axis);
  }
  return deviation;
}

// What the instrument reads of it in every run.
std::vector<std::vector<double>> readings(const std::vector<double>& deviation, double zero,
                                          const InterferometerSetup& setup, Random& random) {
  std::vector<std::vector<double>> runs(static_cast<std::size_t>(setup.runs), deviation);
  for (auto& run : runs) {
    for (double& value : run)
      value += random.normal(setup.repeatability_mm) - zero;
  }
  return runs;
}

}  // namespace

std::vector<host::Positioning> measure_positioning(MotionCell& cell,
                                                   const host::MachineFile& machine,
                                                   const std::string& when,
                                                   const InterferometerSetup& setup,
                                                   Random& random) {
  std::vector<host::Positioning> all;
  const DiagonalBox box = travel_box(machine);
  for (std::size_t a = 0; a < 3; ++a) {
    const host::AxisFile& axis = machine.axes[a];
    const std::vector<double> at = axis.all_targets();
    std::vector<Vec3> target;
    for (const double q : at) {
      target.emplace_back(0.5 * (box.lo + box.hi));
      target.back()(static_cast<Eigen::Index>(a)) = q;
    }
    const auto direction = static_cast<Eigen::Index>(a);
    const std::vector<double> up = pass(cell, target, direction, true);
    const std::vector<double> down = pass(cell, target, direction, false);
    const double zero = 0.5 * (up.front() + down.front());
    const auto runs_up = readings(up, zero, setup, random);
    const auto runs_down = readings(down, zero, setup, random);
    all.push_back(host::evaluate_positioning(axis.letter, false, when, at, runs_up, runs_down));
  }
  return all;
}

std::vector<Vec3> volume_grid(const DiagonalBox& box) {
  constexpr auto kLast = static_cast<double>(kVolumeGrid - 1);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < kVolumeGrid; ++i) {
    for (std::size_t j = 0; j < kVolumeGrid; ++j) {
      for (std::size_t k = 0; k < kVolumeGrid; ++k) {
        const Vec3 share(static_cast<double>(i) / kLast, static_cast<double>(j) / kLast,
                         static_cast<double>(k) / kLast);
        points.emplace_back(box.lo + share.cwiseProduct(box.hi - box.lo));
      }
    }
  }
  return points;
}

std::vector<Vec3> measure_errors(MotionCell& cell, const std::vector<Vec3>& points) {
  std::vector<Vec3> errors;
  for (const Vec3& p : points) {
    cell.move_to(p, kRapid_mm_s);
    errors.push_back(cell.deviation_mm());
  }
  return errors;
}

}  // namespace volcomp::sim
