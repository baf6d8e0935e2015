// A laser and a level in a workshop: what they add to the errors of an axis has the sizes stated,
// and belongs to the reading, the set-up or the instrument that it is stated for.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host_sim/sim/instruments/laser6d.hpp"

namespace volcomp::sim {
namespace {

const std::vector<double> kTargets{-200.0, -100.0, 0.0, 100.0, 200.0};
constexpr LaserPlace kX{Axis::x, -200.0, 200.0};
constexpr std::size_t kRuns = 5;
constexpr std::uint32_t kDraws = 2000;

ErrorMotion no_error(double, double) { return ErrorMotion::Zero(); }

host::RunsFile read(const NoiseClasses& classes, const CampaignDraw& draw, std::uint32_t set_up,
                    const LaserPlace& place = kX, const Laser6D::Truth& truth = no_error) {
  return Laser6D(classes, draw, set_up, place).read_runs('X', kTargets, kRuns, truth);
}

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double v : values)
    squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

// A standard deviation of so many draws is known to 1.6 %: four of these.
constexpr double kShare = 4.0 * 0.016;

TEST(Laser, WithoutNoiseShowsTheErrorsToANanometre) {
  const auto truth = [](double q, double approach) {
    ErrorMotion e;
    e << 1e-5 * q, 2e-3, -1e-3 * approach, 4e-6, 5e-6, 6e-6;
    return e;
  };
  const host::RunsFile runs = read(no_noise(), {3, 4}, 0, kX, truth);
  for (std::size_t t = 0; t < kTargets.size(); ++t) {
    EXPECT_LE((runs.up[1][t] - truth(kTargets[t], 1.0)).cwiseAbs().maxCoeff(), 0.5000001e-6);
    EXPECT_LE((runs.down[1][t] - truth(kTargets[t], -1.0)).cwiseAbs().maxCoeff(), 0.5000001e-6);
  }
}

TEST(Laser, GoesUpThroughTheTargetsAndDownAgain) {
  std::vector<double> seen;
  std::vector<double> before;
  const host::RunsFile runs = bidirectional_runs('X', {1.0, 2.0, 3.0}, 2, [&](const Stop& stop) {
    EXPECT_EQ(stop.number, seen.size());
    seen.push_back(stop.q * stop.approach);
    before.push_back(stop.q_before * stop.approach_before);
    return ErrorMotion(ErrorMotion::Constant(stop.q));
  });
  EXPECT_EQ(runs.down[1][0](0), 1.0);  // by target, not by time
  EXPECT_EQ(seen, (std::vector<double>{1, 2, 3, -3, -2, -1, 1, 2, 3, -3, -2, -1}));
  EXPECT_EQ(before, (std::vector<double>{1, 1, 2, 3, -3, -2, -1, 1, 2, 3, -3, -2}));
}

// The wavelength belongs to the instrument, the levers to the set-up.
TEST(Laser, IsOneInstrumentInAllSetUpsOfACampaign) {
  const NoiseClasses classes;
  const LaserSetup x = mount_laser(classes, {1, 7}, 0);
  const LaserSetup y = mount_laser(classes, {1, 7}, 1);
  const LaserSetup another = mount_laser(classes, {1, 8}, 0);
  EXPECT_EQ(x.scale, y.scale);
  EXPECT_EQ(x.angle_gain, y.angle_gain);
  EXPECT_NE(x.scale, another.scale);
  EXPECT_NE(x.arm_error, y.arm_error);
  EXPECT_NE(x.warmer_K, y.warmer_K);
}

// φ²/2 of a rectangular φ within ± f: from 0 to f²/2, f²/6 in the mean.
TEST(Laser, BeamThatIsNotAlongTheTravelMakesLengthsShorter) {
  const NoiseClasses classes = only(NoiseSource::laser, {});
  const double f = classes.beam_rad;
  double sum = 0.0;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const double shorter = mount_laser(classes, {5, draw}, 2).shorter;
    EXPECT_GE(shorter, 0.0);
    EXPECT_LE(shorter, 0.5 * f * f);
    sum += shorter / kDraws;
  }
  EXPECT_NEAR(sum, f * f / 6.0, 4.0 * f * f / std::sqrt(45.0 * kDraws));
}

// How large a wave is says nothing of where it begins: neither its sine nor its cosine has a mean.
TEST(Laser, WavesBeginAnywhere) {
  const NoiseClasses classes;
  double sine = 0.0;
  double cosine = 0.0;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const LaserSetup s = mount_laser(classes, {6, draw}, 0);
    cosine += s.wave[1] * std::cos(s.wave_phase[1]) / kDraws;
    sine += s.wave[1] * std::sin(s.wave_phase[1]) / kDraws;
  }
  const double chance = classes.straightness_wave_mm / std::sqrt(2.0 * kDraws);
  EXPECT_NEAR(cosine, 0.0, 4.0 * chance);
  EXPECT_NEAR(sine, 0.0, 4.0 * chance);
}

// Standard deviation of each reading as stated; after 5 s e^(-5/900) of it is still there.
TEST(Laser, DriftsAsStated) {
  const NoiseClasses classes = only(NoiseSource::drift, {});
  std::vector<double> first, last, step;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const host::RunsFile runs = read(classes, {9, draw}, 1);
    first.push_back(runs.up.front().front()(0));
    last.push_back(runs.down.back().front()(0));
    step.push_back(runs.up.front()[1](0) - runs.up.front()[0](0));
    EXPECT_EQ(runs.up.front().front()(4), 0.0);  // angles do not drift
  }
  const double s = classes.laser.drift_mm;
  EXPECT_NEAR(rms(first), s, kShare * s);
  EXPECT_NEAR(rms(last), s, kShare * s);
  const double of_step = s * std::sqrt(2.0 * (1.0 - std::exp(-5.0 / 900.0)));
  EXPECT_NEAR(rms(step), of_step, kShare * of_step);
}

TEST(Laser, OneMoreSourceMovesNoOther) {
  NoiseClasses steady;
  steady.laser.drift_mm = 0.0;
  const host::RunsFile without = read(steady, {2, 3}, 0);
  const host::RunsFile with = read({}, {2, 3}, 0);
  const host::RunsFile drift = read(only(NoiseSource::drift, {}), {2, 3}, 0);
  for (std::size_t t = 0; t < kTargets.size(); ++t) {
    const ErrorMotion more = with.up[2][t] - without.up[2][t];
    EXPECT_LE((more - drift.up[2][t]).cwiseAbs().maxCoeff(), 1.6e-6);  // three roundings
  }
}

NoiseClasses with_level() {
  host::MachineFile file;
  file.laser.roll_by_level = true;
  return only(NoiseSource::roll, workshop_noise(file));
}

// 5 µrad of its zero and 0.5 µrad of a reading.
TEST(Level, HasTheErrorsStated) {
  std::vector<double> shown, between;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const host::RunsFile runs = read(with_level(), {4, draw}, 0);
    shown.push_back(runs.up.front().front()(3));
    between.push_back(runs.up.front()[3](3) - runs.up.front()[1](3));
    EXPECT_EQ(runs.up.front().front()(4), 0.0);  // pitch is not its business
  }
  const double zero = std::hypot(5e-6, 0.5e-6);
  EXPECT_NEAR(rms(shown), zero, kShare * zero);
  EXPECT_NEAR(rms(between), 0.5e-6 * std::sqrt(2.0), kShare * 0.71e-6);
}

// With a time constant of 2 s, e^(-5/2) of a step is still to come after 5 s.
TEST(Level, HasNotSettledYet) {
  LevelClass perfect;
  perfect.reading = perfect.zero = perfect.gain = 0.0;
  const Level level(perfect, {}, 0, 5.0);
  EXPECT_NEAR(level.read(20e-6, 20e-6, 0), 20e-6, 1e-18);
  EXPECT_NEAR(level.read(20e-6, 0.0, 1), 20e-6 * (1.0 - std::exp(-2.5)), 1e-18);
}

TEST(Level, DoesNotSeeWhatTurnsAboutTheVertical) {
  constexpr LaserPlace kZ{Axis::z, -200.0, 200.0};
  const host::RunsFile runs = read(with_level(), {4, 1}, 2, kZ);
  for (const host::RunValues& run : runs.up)
    EXPECT_EQ(run.front()(5), 0.0);
}

}  // namespace
}  // namespace volcomp::sim
