#include "host_sim/experiments/xyfz/levers.hpp"

#include <algorithm>

#include "comp/metrology/tables/lever_test.hpp"
#include "host_sim/sim/instruments/sensed_errors.hpp"

namespace volcomp::xyfz {
namespace {

constexpr std::size_t kAxisX = 0;

// Set-ups of the first experiment, those of the second begin this much farther on.
constexpr std::uint32_t kFirstPlace = 2000;
constexpr std::uint32_t kMostPlaces = 16;

sim::NoiseClasses classes_of(const Bench& bench, LeverNoise noise) {
  if (noise == LeverNoise::none) return sim::no_noise();
  sim::NoiseClasses classes = bench.noise();
  if (noise == LeverNoise::instrument) classes.laser.growth_K = 0.0;
  return classes;
}

std::vector<ErrorMotion> measured_at(const Bench& bench, const Vec3& place,
                                     const sim::NoiseClasses& classes, std::size_t runs,
                                     std::size_t draw, std::uint32_t set_up) {
  const host::AxisFile& axis = bench.machine.axes[kAxisX];
  const sim::Laser6D laser(classes, bench.draw(draw), set_up,
                           {bench.machine.chain.axis(kAxisX).axis, axis.lo, axis.hi});
  const sim::SensedErrors errors(bench.truth, kAxisX, {place, axis.sensed.kappa}, laser.setup());
  return sim::mean_of_runs(
      laser.read_runs(axis.letter, axis.all_targets(), runs,
                      [&](double q, double approach) { return errors.at(q, approach); }));
}

// Positioning, µm, zero at the reference target.
std::vector<double> positioning_of(const std::vector<ErrorMotion>& values,
                                   const host::AxisFile& axis) {
  const double zero = values[axis.reference_target()](kAxisX);
  std::vector<double> um;
  um.reserve(values.size());
  for (const ErrorMotion& value : values)
    um.push_back(kUmPerMm * (value(kAxisX) - zero));
  return um;
}

double apart_um(const LeverCurves& curves) {
  double worst = 0.0;
  for (std::size_t t = 0; t < curves.front().size(); ++t) {
    double least = curves.front()[t];
    double most = least;
    for (const std::vector<double>& curve : curves) {
      least = std::min(least, curve[t]);
      most = std::max(most, curve[t]);
    }
    worst = std::max(worst, most - least);
  }
  return worst;
}

void test_levers(const Bench& bench, const LeverExperiment& e,
                 const std::vector<ErrorMotion>& first, const std::vector<ErrorMotion>& last,
                 LeverReadings& out) {
  LeverTest test;
  const Status status =
      lever_self_test(bench.machine.chain.axis(kAxisX).axis, {first.data(), first.size()},
                      {last.data(), last.size()}, e.place.front(), e.place.back(), test);
  out.test = status.reason;
  out.found_mm = test.found.at(e.angle);
}

}  // namespace

double LeverExperiment::lever_mm() const {
  const Vec3 difference = place.back() - place.front();
  return angle == 0 ? difference.z() : -difference.y();
}

std::array<LeverExperiment, 2> lever_experiments() {
  return {{{"at heights of 250, 430 and 550 mm",
            0,
            {Vec3(250.0, 0.0, 250.0), Vec3(250.0, 0.0, 430.0), Vec3(250.0, 0.0, 550.0)},
            Vec3(250.0, 0.0, 0.0),
            2.0},
           {"at 0 and 290 mm sideways",
            1,
            {Vec3(250.0, 0.0, 250.0), Vec3(250.0, 290.0, 250.0)},
            Vec3(250.0, 0.0, 250.0),
            1.3}}};
}

double LeverReadings::measured_apart_um() const { return apart_um(measured); }
double LeverReadings::carried_apart_um() const { return apart_um(carried); }

LeverReadings measure_levers(const Bench& bench, const LeverExperiment& experiment,
                             LeverNoise noise, std::size_t draw) {
  const host::AxisFile& axis = bench.machine.axes[kAxisX];
  const sim::NoiseClasses classes = classes_of(bench, noise);
  const std::size_t runs = noise == LeverNoise::none ? 1 : bench.options.runs;
  LeverReadings out;
  out.position_mm = axis.all_targets();
  std::uint32_t set_up = kFirstPlace + kMostPlaces * static_cast<std::uint32_t>(experiment.angle);
  std::vector<std::vector<ErrorMotion>> at_place;
  for (const Vec3& place : experiment.place) {
    at_place.push_back(measured_at(bench, place, classes, runs, draw, set_up++));
    out.measured.push_back(positioning_of(at_place.back(), axis));
    std::vector<ErrorMotion> carried;
    carried.reserve(at_place.back().size());
    for (const ErrorMotion& value : at_place.back())
      carried.push_back(at_head(value, place - experiment.carried_to));
    out.carried.push_back(positioning_of(carried, axis));
  }
  test_levers(bench, experiment, at_place.front(), at_place.back(), out);
  return out;
}

}  // namespace volcomp::xyfz
