// The study of many machines (docs/papers/xyfz.md): each is the paper's by its raw figures, and no
// figure of one depends on the others or on who computes it.

#include <gtest/gtest.h>

#include "host_sim/experiments/xyfz/machines.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "tests/complaint.hpp"

namespace volcomp::sim {
namespace {

constexpr std::size_t kNaive = 0;
constexpr std::size_t kPaperModel = 1;
constexpr std::size_t kClosedModel = 2;

xyfz::XyfzOptions two_machines() {
  xyfz::XyfzOptions options;
  options.machine = host::bundled_machine("xyfz");
  options.machines = 2;
  options.draws = 2;
  options.threads = host::processors();
  return options;
}

xyfz::MachinesResult run(const xyfz::XyfzOptions& options) {
  return xyfz::run_machines(options, [](double, const std::string&) {});
}

const xyfz::MachinesResult& result() {
  static const xyfz::MachinesResult r = run(two_machines());
  return r;
}

// Tuned, and the paper's: 41.15 µm measured, 16.37 µm left by its usual model.
TEST(XyfzMachines, EachShowsThePapersRawFigures) {
  ASSERT_EQ(result().machine.size(), 2U);
  for (const xyfz::StudiedMachine& m : result().machine) {
    EXPECT_NEAR(m.noise_free.raw_um, 41.15, 0.01) << m.seed;
    EXPECT_NEAR(m.noise_free.residual_um[kNaive], 16.37, 0.05) << m.seed;
  }
}

// Not tuned: the reference found at most 0.73 µm left on 26 machines.
TEST(XyfzMachines, ClosedModelLeavesNextToNothingOnEachWithoutNoise) {
  for (const xyfz::StudiedMachine& m : result().machine)
    EXPECT_LT(m.noise_free.residual_um[kClosedModel], 0.73) << m.seed;
}

TEST(XyfzMachines, FirstOneIsTheMachineOfTheWholeScenario) {
  xyfz::XyfzOptions options = two_machines();
  options.volume_points = 20;
  options.tick_points = 1000;
  const xyfz::XyfzResult alone = xyfz::run_xyfz(options, [](double, const std::string&) {});
  const xyfz::StudiedMachine& first = result().machine.front();
  ASSERT_EQ(first.draws.size(), alone.draws.size());
  for (std::size_t d = 0; d < alone.draws.size(); ++d) {
    EXPECT_DOUBLE_EQ(first.draws[d].raw_um, alone.draws[d].raw_um);
    EXPECT_EQ(first.draws[d].residual_um, alone.draws[d].residual_um);
  }
  EXPECT_DOUBLE_EQ(first.noise_free.rate(kPaperModel), alone.rate(2));
  EXPECT_DOUBLE_EQ(first.noise_free.rate(kClosedModel), alone.rate(3));
}

// What circles and lines read of one machine differs by its form alone, angles by straightness, and
// the squareness itself by nothing.
TEST(XyfzMachines, CirclesLessLinesIsTheFormOfTheAxes) {
  for (const xyfz::StudiedMachine& m : result().machine) {
    for (std::size_t plane = 0; plane < 3; ++plane) {
      const xyfz::CirclesLessLines& f = m.functionals;
      EXPECT_GT(std::abs(f.all[plane]), 0.1) << m.seed;
      EXPECT_NEAR(f.all[plane], f.without_angles[plane] + f.angles[plane], 0.02) << m.seed;
    }
  }
}

// One bow, EYX over X: the line reads its slope of least squares, the circle twice the second
// harmonic of E(R cos θ) sin θ over R.
TEST(XyfzMachines, CirclesLessLinesOfOneCurvedAxis) {
  const host::MachineFile file = host::read_machine_file(host::bundled_machine("xyfz"));
  TrueMachine bent;
  bent.chain = file.chain;
  for (std::size_t a = 0; a < 3; ++a) {
    bent.axis[a].lo = file.axes[a].lo;
    bent.axis[a].hi = file.axes[a].hi;
  }
  const xyfz::CirclesLessLines none = xyfz::circles_less_lines(bent, file);
  for (const double urad : none.all)
    EXPECT_NEAR(urad, 0.0, 1e-6);
  bent.axis[0].channel[1].amplitude[0] = 10e-3;
  const xyfz::CirclesLessLines f = xyfz::circles_less_lines(bent, file);
  const double length = file.axes[0].hi - file.axes[0].lo;
  const auto bow = [&](double x) { return 10e-3 * std::sin(kPi * (x - file.axes[0].lo) / length); };
  const std::vector<double> line = file.squareness->line(0);
  double line_mean = 0.0;
  for (const double x : line)
    line_mean += x / static_cast<double>(line.size());
  double moment = 0.0;
  double squares = 0.0;
  for (const double x : line) {
    moment += (x - line_mean) * bow(x);
    squares += (x - line_mean) * (x - line_mean);
  }
  constexpr int kSteps = 720;
  double second_harmonic = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 2.0 * kPi * k / kSteps;
    const double r =
        bow(file.squareness->at.x() + xyfz::kBallBar_mm * std::cos(angle)) * std::sin(angle);
    second_harmonic += 2.0 * r * std::sin(2.0 * angle) / kSteps;
  }
  EXPECT_NEAR(f.all[0], 1e6 * (2.0 * second_harmonic / xyfz::kBallBar_mm - moment / squares), 0.02);
  EXPECT_NEAR(f.all[1], 0.0, 1e-3);
  EXPECT_NEAR(f.all[2], 0.0, 1e-3);
  EXPECT_EQ(f.without_angles, f.all);
  EXPECT_NEAR(f.angles[0], 0.0, 1e-6);
}

TEST(XyfzMachines, RefusesAMachineOfAnotherKind) {
  xyfz::XyfzOptions options = two_machines();
  options.machine = host::bundled_machine("l300g");
  const std::string complaint = complaint_of([&] { return run(options); });
  EXPECT_NE(complaint.find("needs three linear axes"), std::string::npos) << complaint;
}

TEST(XyfzMachines, MedianOfFourIsBetweenTheMiddleTwo) {
  EXPECT_DOUBLE_EQ(xyfz::quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(xyfz::quantile({4.0, 1.0, 3.0, 2.0}, 0.05), 1.15);
  EXPECT_DOUBLE_EQ(xyfz::quantile({7.0}, 0.95), 7.0);
}

// Nine machines of ten are wanted, and no fewer than the paper's own variant has.
TEST(XyfzMachines, VerdictCountsMachines) {
  xyfz::MachinesResult r;
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    r.machine.push_back({seed, {}, {100.0, {40.0, 10.0, seed == 1 ? 20.0 : 1.0}}, {}, {}});
  r.options.draws = 0;
  EXPECT_EQ(r.reaching(kClosedModel), 9U);
  EXPECT_EQ(r.reaching(kPaperModel), 10U);
  EXPECT_FALSE(xyfz::machines_verdict(r).ok);
  for (xyfz::StudiedMachine& m : r.machine)
    m.noise_free.residual_um[kPaperModel] = 20.0;
  EXPECT_TRUE(xyfz::machines_verdict(r).ok);
  r.machine.back().noise_free.residual_um[kClosedModel] = 20.0;
  EXPECT_FALSE(xyfz::machines_verdict(r).ok);
}

}  // namespace
}  // namespace volcomp::sim
