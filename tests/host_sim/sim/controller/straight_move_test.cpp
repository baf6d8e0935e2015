// Straight moves of linear and rotary axes together.

#include <gtest/gtest.h>

#include "comp/core/units.hpp"
#include "host_sim/sim/controller/straight_move.hpp"

namespace volcomp::sim {
namespace {

// X, Y, B, A.
constexpr host::AxisKinds kGrinder{4, {false, false, true, true}};

double fastest(const StraightMove& move, std::size_t axis) {
  constexpr double kStep_s = 1e-4;
  double fastest = 0.0;
  for (double t = 0.0; t < move.duration_s(); t += kStep_s)
    fastest = std::max(fastest, std::abs(move.at(t + kStep_s)[axis] - move.at(t)[axis]) / kStep_s);
  return fastest;
}

TEST(StraightMove, EveryAxisIsAtTheSamePartOfItsWay) {
  const Pose from{10.0, 200.0, -0.7, 1.0};
  const Pose to{40.0, 160.0, -0.6, 0.5};
  const StraightMove move(from, to, kGrinder, 20.0);
  for (const double t : {0.003, 0.4, 1.7, 2.5}) {
    const double part = (move.at(t)[0] - 10.0) / 30.0;
    EXPECT_GT(part, 0.0);
    for (std::size_t a = 1; a < 4; ++a)
      EXPECT_NEAR((move.at(t)[a] - from[a]) / (to[a] - from[a]), part, 1e-12);
  }
  for (std::size_t a = 0; a < 4; ++a)
    EXPECT_NEAR(move.at(move.duration_s())[a], to[a], 1e-12);
}

// RS274/NGC: 50 mm of X and Y at 20 mm/s, whatever turns meanwhile.
TEST(StraightMove, FeedIsThatOfTheLinearAxes) {
  const StraightMove move({0.0, 0.0, 0.0, 0.0}, {30.0, 40.0, 0.2, 0.1}, kGrinder, 20.0);
  EXPECT_NEAR(move.duration_s(), 50.0 / 20.0 + 20.0 / kAcceleration_mm_s2, 1e-12);
  EXPECT_NEAR(fastest(move, 0), 12.0, 1e-6);
  EXPECT_NEAR(fastest(move, 1), 16.0, 1e-6);
}

TEST(StraightMove, FeedIsInRadiansWhereOnlyRotaryAxesMove) {
  const StraightMove move({5.0, 5.0, 0.0, 0.0}, {5.0, 5.0, 0.3, 0.4}, kGrinder, 0.1);
  EXPECT_NEAR(move.duration_s(), 0.5 / 0.1 + 0.1 / kAcceleration_rad_s2, 1e-12);
  EXPECT_NEAR(fastest(move, 3), 0.08, 1e-9);
}

TEST(StraightMove, AShortWayOfALinearAxisDoesNotHurlARotaryOne) {
  const StraightMove move({0.0, 0.0, 0.0, 0.0}, {0.001, 0.0, 0.0, 2.0}, kGrinder, 100.0);
  EXPECT_LE(fastest(move, 3), kMostTurning_rad_s + 1e-9);
}

TEST(StraightMove, BrakesOverTheSquareOfTheSpeedByTwiceTheAcceleration) {
  const StraightMove move({0.0}, {100.0}, kGrinder, 20.0);
  const double begin = move.at(1.0)[0];
  EXPECT_NEAR(move.braking(1.0, 1e9)[0] - begin, 20.0 * 20.0 / (2.0 * kAcceleration_mm_s2), 1e-12);
  EXPECT_EQ(move.braking(1.0, 0.0)[0], begin);
  EXPECT_NEAR(move.braking(1.0, 0.005)[0] - begin, 20.0 * 0.005 - 0.5 * 2000.0 * 25e-6, 1e-12);
  // Already slowing down at the end, it just goes on.
  EXPECT_NEAR(move.braking(move.duration_s() - 0.002, 1.0)[0], 100.0, 1e-12);
}

TEST(AxisKinds, CountInNanometresAndTwoToTheMinusFortyTurns) {
  const host::Targets units = kGrinder.targets({1.0, -0.0000005, kPi, -2.0 * kPi});
  EXPECT_EQ(units,
            (host::Targets{1'000'000, -1, std::int64_t{1} << 39, -(std::int64_t{1} << 40), 0}));
}

}  // namespace
}  // namespace volcomp::sim
