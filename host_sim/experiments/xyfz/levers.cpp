#include "host_sim/experiments/xyfz/levers.hpp"

#include <algorithm>

#include "comp/metrology/statistics/random_stream.hpp"
#include "comp/metrology/tables/lever_test.hpp"
#include "host_sim/sim/instruments/laser6d.hpp"

namespace volcomp::xyfz {
namespace {

constexpr std::size_t kAxisX = 0;

// Set-ups of the first experiment are 0, 1, …, those of the second begin here.
constexpr std::uint32_t kMostPlaces = 16;

sim::Random random_of(std::uint64_t seed, std::size_t draw, std::uint32_t set_up) {
  const RandomWords words = random_words(seed, {static_cast<std::uint32_t>(RandomStream::laser),
                                                static_cast<std::uint32_t>(draw), set_up, kCommon});
  return sim::Random((std::uint64_t{words[0]} << 32U) | words[1]);
}

// The same instrument, put up anew.
sim::LaserSetup put_up(const sim::LaserSetup& instrument, const sim::NoiseClasses& classes,
                       sim::Random& random) {
  sim::LaserSetup s = sim::mount_laser(classes, random);
  s.scale = instrument.scale;
  s.straightness_gain = instrument.straightness_gain;
  s.angle_gain = instrument.angle_gain;
  s.roll = instrument.roll;
  return s;
}

// Mean of all runs of both directions, by target.
std::vector<ErrorMotion> means_of(const host::RunsFile& runs) {
  std::vector<ErrorMotion> mean(runs.positions.size(), ErrorMotion::Zero());
  const auto n = static_cast<double>(runs.up.size() + runs.down.size());
  for (const auto* list : {&runs.up, &runs.down})
    for (const host::RunValues& run : *list)
      for (std::size_t t = 0; t < run.size(); ++t)
        mean[t] += run[t] / n;
  return mean;
}

// One set-up, with the noise of `random`.
std::vector<ErrorMotion> measured_at(const Bench& bench, const Vec3& place, LeverNoise noise,
                                     const sim::LaserSetup& instrument, sim::Random& random) {
  const bool noisy = noise != LeverNoise::none;
  const sim::NoiseClasses classes = noisy ? sim::NoiseClasses{} : sim::no_noise();
  const sim::LaserSetup setup = put_up(instrument, classes, random);
  sim::TrueMachine truth = bench.truth;
  const double warmer_K = random.normal(classes.temperature_K);
  if (noise == LeverNoise::temperature) truth.temperature_offset_K = warmer_K;
  const host::AxisFile& axis = bench.machine.axes[kAxisX];
  const sim::Laser6D laser(truth, kAxisX, {place, axis.sensed.kappa}, setup);
  return means_of(sim::bidirectional_runs(
      axis.letter, axis.all_targets(), noisy ? bench.options.runs : 1,
      [&](double q, double approach) { return laser.read(q, approach, classes, random); }));
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
  const std::uint64_t seed = bench.options.seed;
  sim::Random common = random_of(seed, draw, kCommon);
  const sim::LaserSetup instrument =
      sim::mount_laser(noise == LeverNoise::none ? sim::no_noise() : sim::NoiseClasses{}, common);
  LeverReadings out;
  out.position_mm = axis.all_targets();
  std::vector<std::vector<ErrorMotion>> at_place;
  for (const Vec3& place : experiment.place) {
    const auto set_up = static_cast<std::uint32_t>(at_place.size());
    sim::Random random =
        random_of(seed, draw, set_up + kMostPlaces * static_cast<std::uint32_t>(experiment.angle));
    at_place.push_back(measured_at(bench, place, noise, instrument, random));
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
