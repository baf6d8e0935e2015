// The simulated YK7280 keeps what the paper's section 3.1 promises, and its touches scatter as
// their class and their scales say.

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "comp/metrology/statistics/random_stream.hpp"
#include "host_sim/experiments/face_gear/scenario.hpp"
#include "host_sim/experiments/face_gear/traced_table.hpp"

namespace volcomp::face_gear {
namespace {

constexpr int kMachines = 16;

host::MachineFile yk7280() { return host::read_machine_file(host::bundled_machine("yk7280")); }

// What a displacement error does over a travel, every millimetre, µm.
std::vector<double> curve(const sim::TrueMachine& machine, std::size_t axis, int channel) {
  const sim::TrueAxis& a = machine.axis.at(axis);
  std::vector<double> um;
  for (double q = a.lo; q <= a.hi; q += 1.0)
    um.push_back(kUmPerMm * machine.relative_error(axis, q, 0.0)(channel));
  return um;
}

// Range about the line through the ends of a piece.
double off_straight(const std::vector<double>& um, std::size_t begin, std::size_t steps) {
  double least = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(steps);
    const double off = um[begin + i] - (1.0 - part) * um[begin] - part * um[begin + steps];
    least = std::min(least, off);
    most = std::max(most, off);
  }
  return most - least;
}

// Rise over the whole travel, rad.
double slope(const std::vector<double>& um) {
  return (um.back() - um.front()) / kUmPerMm / static_cast<double>(um.size() - 1);
}

TEST(FaceMachine, SlidesAreStraightWithinTwoMicrometresIn200mmAndNoBetter) {
  const host::MachineFile file = yk7280();
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
    const sim::TrueMachine machine = make_yk7280_truth(file, seed);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (int channel = 0; channel < 3; ++channel) {
        if (static_cast<std::size_t>(channel) == axis) continue;
        const std::vector<double> um = curve(machine, axis, channel);
        double worst = 0.0;
        for (std::size_t begin = 0; begin + 200 < um.size(); ++begin)
          worst = std::max(worst, off_straight(um, begin, 200));
        EXPECT_LT(worst, 2.03) << seed << ' ' << axis << ' ' << channel;
        EXPECT_GT(worst, 1.97) << seed << ' ' << axis << ' ' << channel;
      }
    }
  }
}

TEST(FaceMachine, AxesAreSquareWithin10In267AndZIsParallelToTheTable) {
  constexpr double kSquare = 10e-3 / 267.0;
  const host::MachineFile file = yk7280();
  double most = 0.0;
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
    const sim::TrueMachine machine = make_yk7280_truth(file, seed);
    const auto rise = [&](std::size_t axis, int towards) {
      return slope(curve(machine, axis, towards));
    };
    const double xy = rise(0, 1) + rise(1, 0);
    for (const double off :
         {xy, rise(0, 2), rise(1, 2), rise(0, 2) + rise(2, 0), rise(1, 2) + rise(2, 1)}) {
      EXPECT_LT(std::abs(off), 1.001 * kSquare) << seed;
      most = std::max(most, std::abs(off));
    }
    EXPECT_LT(std::abs(rise(2, 0)), 10.01e-6) << seed;
    EXPECT_LT(std::abs(rise(2, 1)), 10.01e-6) << seed;
  }
  EXPECT_GT(most, 0.8 * kSquare);  // the limit is used
}

TEST(FaceMachine, TheTableRunsOutByOneAndAHalfMicrometresAtMost) {
  const host::MachineFile file = yk7280();
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
    const sim::TrueMachine machine = make_yk7280_truth(file, seed);
    for (int channel = 0; channel < 5; ++channel) {
      const double lever = channel < 3 ? kUmPerMm : kUmPerMm * 200.0;  // tilt at the rim
      double least = 1e9;
      double most = -1e9;
      for (int i = 0; i <= 720; ++i) {
        const double um = lever * machine.relative_error(3, 2.0 * kPi * i / 720.0, 0.0)(channel);
        least = std::min(least, um);
        most = std::max(most, um);
      }
      EXPECT_LE(most - least, 1.5001) << seed << ' ' << channel;
      EXPECT_GT(most - least, 0.9) << seed << ' ' << channel;
    }
  }
}

// Rectangular steps of 1 µm have a standard deviation of 1/√12 µm.
TEST(FaceScatter, IsThatOfTheProbeAndOfTheScales) {
  FaceGearOptions options;
  EXPECT_FALSE(static_cast<bool>(scatter_of(options).of_set_up(1)));
  options.probe = 2;
  const FaceScatter lp2 = scatter_of(options);
  EXPECT_NEAR(lp2.sigma_mm(), std::sqrt(0.25 + 1.0 / 12.0) / kUmPerMm, 1e-9);
  const auto touch = lp2.of_set_up(7);
  constexpr std::uint32_t kTouches = 20000;
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint32_t k = 0; k < kTouches; ++k) {
    const double um = kUmPerMm * touch(k);
    sum += um;
    squares += um * um;
  }
  EXPECT_NEAR(sum / kTouches, 0.0, 4.0 * 0.577 / std::sqrt(kTouches));
  EXPECT_NEAR(std::sqrt(squares / kTouches), 0.5774, 4.0 * 0.5774 / std::sqrt(2.0 * kTouches));
}

// The number of a touch is that of measurement.md, section 1.1: a function of what it is for alone.
TEST(FaceScatter, TakesTheNumberOfItsTouch) {
  FaceScatter scatter;
  scatter.probe.noise.repeatability_2s = 2e-3;
  scatter.seed = 5;
  const auto touch = scatter.of_set_up(7);
  for (const std::uint32_t k : {3U, 0U, 3U})
    EXPECT_DOUBLE_EQ(touch(k), 1e-3 * normal(5, {1, 0, 7, k}));
}

TEST(FaceIdentification, ThePlanSeesEverything) {
  EXPECT_EQ(sim::refusal_of(yk7280(), traced_plan(0.0)), std::vector<std::string>{});
}

// Without noise what splines leave of waves of 1.5 to 3 µm and three to the turn.
TEST(FaceIdentification, FindsTheMachineWithoutNoise) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const sim::TracedErrors found =
        sim::trace_errors(make_yk7280_truth(yk7280(), seed), yk7280(), traced_plan(0.0), {true});
    EXPECT_LT(found.largest_mm, 0.05e-3) << seed;
    EXPECT_LT(found.largest_rad, 1e-6) << seed;
  }
}

// With tracer, stations and the steps of the scales.
TEST(FaceIdentification, ScattersAsItPredicts) {
  constexpr std::uint32_t kDraws = 10;
  double ratio = 0.0;
  for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
    const sim::TracedErrors found =
        sim::trace_errors(make_yk7280_truth(yk7280(), 1), yk7280(), traced_plan(kSlideStep_mm),
                          {false, 0.1e-3, 5, draw});
    EXPECT_NEAR(found.chi2_over_dof, 1.0, 0.2) << draw;
    ratio += std::pow(found.rms_mm / found.u_rms_mm, 2.0) / kDraws;
  }
  EXPECT_NEAR(std::sqrt(ratio), 1.0, 0.3);
}

TEST(FacePlan, TouchesEveryCellOfAMapAndEveryFlankOnce) {
  std::set<std::pair<std::size_t, std::size_t>> cells;
  for (const PlannedTouch& touch : map_touches({1, 3})) {
    EXPECT_EQ(touch.flank.slot, 3);
    cells.emplace(touch.row, touch.column);
  }
  EXPECT_EQ(cells.size(), 105U);
  std::set<int> slots;
  for (const PlannedTouch& touch : pitch_touches(-1, 86))
    slots.insert(touch.flank.slot);
  EXPECT_EQ(slots.size(), 86U);
  EXPECT_EQ(frame_touches(86).size(), 30U);
  EXPECT_EQ(mapped_slots(4, 142), (std::vector<int>{0, 35, 71, 106}));
}

}  // namespace
}  // namespace volcomp::face_gear
