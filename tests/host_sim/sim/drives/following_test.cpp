// How the axis follows: a first-order lag, read by an encoder of 1 nm, at the pace of SYNC or of
// the drive's own clock.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

TEST(Following, AStepIsAnsweredByOneMinusExp) {
  Bench bench;
  bench.enable();
  constexpr double kStep_nm = 1e6;
  for (int n = 1; n <= 20; ++n) {
    bench.cycle(0x0F, static_cast<std::int32_t>(kStep_nm));
    const double expected = kStep_nm * (1.0 - std::exp(-n * 0.001 / 0.002));
    EXPECT_NEAR(bench.drive.position_units(), expected, 1e-6);
    EXPECT_EQ(bench.drive.objects().actual, std::llround(expected));
    EXPECT_EQ(bench.drive.objects().following_error, 1'000'000 - std::llround(expected));
  }
}

TEST(Following, TheEncoderRoundsToTheNearestNanometre) {
  Bench bench;
  bench.enable();
  for (int i = 0; i < 5; ++i) {
    bench.cycle(0x0F, 7);
    const double position = bench.drive.position_units();
    EXPECT_LE(std::abs(bench.drive.objects().actual - position), 0.5);
    EXPECT_NEAR(bench.drive.position_mm() * 1e6, position, 1e-9);
  }
}

TEST(Following, TheAxisShowsFromWhereItCame) {
  Bench bench;
  bench.enable();
  for (int i = 0; i < 50; ++i)
    bench.cycle(0x0F, 100'000);
  EXPECT_EQ(bench.drive.approach(), 1.0);
  for (int i = 0; i < 50; ++i)
    bench.cycle(0x0F, 0);
  EXPECT_EQ(bench.drive.approach(), -1.0);
}

// Four servo periods to a SYNC give the position that four SYNCs of one period each would.
TEST(Following, TheServoClockRunsOnBetweenSyncs) {
  Bench every;
  Bench fourth;
  every.enable();
  fourth.enable();
  for (int i = 0; i < 4; ++i)
    every.cycle(0x0F, 400'000);
  fourth.cycle(0x0F, 400'000);
  fourth.wait(4 * Bench::kPeriod_us - 100);
  EXPECT_EQ(fourth.drive.position_units(), every.drive.position_units());
}

}  // namespace
}  // namespace volcomp::sim
