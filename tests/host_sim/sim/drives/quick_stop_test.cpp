// Quick stop: by command, because the controller fell silent, because the network left OPERATIONAL.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

constexpr std::int32_t kStep = 100'000;  // 0.1 mm per ms = 0.1 m/s; with 2 m/s² 50 ms and 2.5 mm

class QuickStop : public testing::Test {
 protected:
  void SetUp() override {
    bench.enable();
    for (int i = 0; i < 40; ++i)
      bench.cycle(0x0F, target += kStep);
    start = bench.drive.position_units();
  }
  // Until the state is left that brakes, at most 200 ms.
  void wait_for_standstill() {
    for (int i = 0; i < 200 && bench.drive.power_state() == host::PowerState::quick_stop_active;
         ++i)
      bench.wait(Bench::kPeriod_us);
  }
  [[nodiscard]] double braking_distance() const { return bench.drive.position_units() - start; }

  Bench bench;
  std::int32_t target = 0;
  double start = 0.0;
};

TEST_F(QuickStop, SlowsDownEvenly) {
  // Each period is shorter than the last by a T² = 2 m/s² · (1 ms)² = 2 µm.
  bench.cycle(0x02, target);
  double before = bench.drive.position_units() - start;
  EXPECT_NEAR(before, kStep - 2000.0, 2.0);
  for (int i = 0; i < 20; ++i) {
    const double from = bench.drive.position_units();
    bench.cycle(0x02, target);
    const double step = bench.drive.position_units() - from;
    EXPECT_NEAR(before - step, 2000.0, 2.0);
    before = step;
  }
  EXPECT_EQ(bench.statusword() & 0x006F, 0x0007);
}

TEST_F(QuickStop, TakesTheDistanceOfItsDeceleration) {
  bench.cycle(0x02, target);
  wait_for_standstill();
  // v²/2a = 2.5 mm, less half a period at full speed for the steps in which it is counted.
  EXPECT_NEAR(braking_distance(), 2.5e6 - kStep / 2.0, 100.0);
}

TEST_F(QuickStop, Option2EndsInSwitchOnDisabled) {
  bench.cycle(0x02, target);
  wait_for_standstill();
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0040);
  const double stands = bench.drive.position_units();
  bench.cycle(0x0F, target);
  EXPECT_EQ(bench.drive.position_units(), stands);
}

TEST_F(QuickStop, Option6StaysAndCanBeLeftByEnabling) {
  ASSERT_EQ(bench.write(0x605A, 0, 6, 2), 0U);
  bench.cycle(0x02, target);
  wait_for_standstill();
  EXPECT_EQ(bench.statusword() & 0x006F, 0x0007);
  const double stands = bench.drive.position_units();
  bench.cycle(0x0F, target);
  EXPECT_EQ(bench.statusword() & 0x106F, 0x0027);
  EXPECT_NEAR(bench.drive.position_units(), stands, 0.5);
}

TEST_F(QuickStop, ASilentControllerStopsTheAxisAndRaises8130) {
  ASSERT_EQ(bench.write(0x1016, 1, 0x7F'0014, 4), 0U);  // node 127, 20 ms
  bench.give(0x77F, {0x05});
  for (int i = 0; i < 20; ++i)
    bench.cycle(0x0F, target += kStep);
  EXPECT_EQ(bench.statusword() & 0x006F, 0x0027);
  EXPECT_TRUE(bench.emergencies.empty());
  bench.wait(Bench::kPeriod_us);
  EXPECT_EQ(bench.statusword() & 0x006F, 0x0007);
  ASSERT_EQ(bench.emergencies.size(), 1U);
  EXPECT_EQ(bench.emergencies[0], frame(0x083, {0x30, 0x81, 0x11, 0x7F, 0, 0, 0, 0}));
  wait_for_standstill();
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0040);
}

TEST_F(QuickStop, TheLostHeartbeatFollows1029) {
  ASSERT_EQ(bench.write(0x1016, 1, 0x7F'0014, 4), 0U);
  bench.give(0x77F, {0x05});
  bench.wait(22'000);
  EXPECT_EQ(bench.drive.device().state(), canopen::NmtState::pre_operational);
}

TEST_F(QuickStop, LeavingOperationalStopsTheAxis) {
  bench.give(0x000, {0x80, 0x03});  // enter PRE-OPERATIONAL
  EXPECT_EQ(bench.statusword() & 0x006F, 0x0007);
  wait_for_standstill();
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0040);
  EXPECT_GT(braking_distance(), 2e6);
}

TEST_F(QuickStop, AbortConnectionOption0LetsTheAxisFollow) {
  ASSERT_EQ(bench.write(0x6007, 0, 0, 2), 0U);
  bench.give(0x000, {0x02, 0x03});  // stop
  bench.wait(50'000);
  EXPECT_EQ(bench.statusword() & 0x006F, 0x0027);
  EXPECT_EQ(bench.drive.objects().actual, target);
}

TEST_F(QuickStop, AbortConnectionOption1IsAFault) {
  ASSERT_EQ(bench.write(0x6007, 0, 1, 2), 0U);
  bench.give(0x000, {0x80, 0x03});
  EXPECT_EQ(bench.statusword() & 0x004F, 0x000F);
  bench.wait(100'000);
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0008);
  EXPECT_EQ(bench.read(0x603F, 0), 0x8100U);
}

TEST_F(QuickStop, AbortConnectionOption2SwitchesOff) {
  ASSERT_EQ(bench.write(0x6007, 0, 2, 2), 0U);
  bench.give(0x000, {0x80, 0x03});
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0040);
}

TEST_F(QuickStop, WithoutPowerTheAxisStandsAndSaysNothing) {
  bench.drive.power_off();
  bench.sent.clear();
  bench.wait(5000);
  bench.give(0x080, {});
  EXPECT_EQ(braking_distance(), 0.0);
  EXPECT_TRUE(bench.sent.empty());
  bench.drive.power_on(bench.now_us);
  bench.wait(100);
  EXPECT_EQ(bench.sent.at(0), frame(0x703, {0x00}));
  EXPECT_EQ(bench.drive.objects().actual, std::llround(start));
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0040);
}

}  // namespace
}  // namespace volcomp::sim
