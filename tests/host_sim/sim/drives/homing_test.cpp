// Homing on the current position (method 37), and how long the reference lasts.

#include <gtest/gtest.h>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint16_t kReferencedBit = 0x0100;
constexpr std::uint16_t kAttained = 0x1000;

class Homing : public testing::Test {
 protected:
  Homing() {
    bench.drive.stand_at(5000);
    bench.enable(5000);
    bench.write(0x6060, 0, 6, 1);
  }
  void home() {
    bench.cycle(0x0F, 0);
    bench.cycle(0x1F, 0);
  }
  Bench bench;
};

TEST_F(Homing, StartsWithTheRisingEdgeOfBit4) {
  bench.cycle(0x0F, 0);
  EXPECT_EQ(bench.read(0x6061, 0), 6U);
  EXPECT_EQ(bench.statusword() & (kReferencedBit | kAttained), 0);
  bench.cycle(0x1F, 0);
  EXPECT_EQ(bench.statusword() & 0x3400, 0x1400);  // attained, target reached, no error
  EXPECT_EQ(bench.statusword() & kReferencedBit, kReferencedBit);
}

TEST_F(Homing, TheAxisStandsAndReadsTheHomeOffset) {
  ASSERT_EQ(bench.write(0x607C, 0, -250, 4), 0U);
  home();
  EXPECT_EQ(bench.drive.objects().actual, -250);
  EXPECT_EQ(bench.drive.position_units(), 5000.0);
}

TEST_F(Homing, AHomeOffsetNobodyGaveIsTheReading) {
  EXPECT_EQ(bench.read(0x607C, 0), 5000U);
  home();
  EXPECT_EQ(bench.drive.objects().actual, 5000);
}

TEST_F(Homing, TargetsCountFromTheNewZero) {
  ASSERT_EQ(bench.write(0x607C, 0, 0, 4), 0U);
  home();
  bench.write(0x6060, 0, 8, 1);
  for (int i = 0; i < 50; ++i)
    bench.cycle(0x0F, 100);
  EXPECT_EQ(bench.drive.objects().actual, 100);
  EXPECT_NEAR(bench.drive.position_units(), 5100.0, 1e-3);
}

TEST_F(Homing, TargetsAreIgnoredMeanwhile) {
  bench.cycle(0x0F, 90'000);
  bench.cycle(0x0F, 90'000);
  EXPECT_EQ(bench.drive.objects().actual, 5000);
}

TEST_F(Homing, NotEnabledNothingHappens) {
  bench.cycle(0x07, 0);
  bench.cycle(0x17, 0);
  EXPECT_EQ(bench.statusword() & kReferencedBit, 0);
}

TEST_F(Homing, TheReferenceSurvivesModesAndDisabling) {
  home();
  bench.write(0x6060, 0, 8, 1);
  bench.cycle(0x00, 0);
  EXPECT_EQ(bench.statusword() & 0x014F, 0x0140);
}

TEST_F(Homing, ResetNodeLosesTheReferenceNotThePosition) {
  ASSERT_EQ(bench.write(0x607C, 0, 777, 4), 0U);
  home();
  bench.give(0x000, {0x81, 0x03});
  EXPECT_EQ(bench.statusword() & kReferencedBit, 0);
  EXPECT_EQ(bench.drive.objects().actual, 777);
}

TEST_F(Homing, ResetCommunicationKeepsTheReference) {
  home();
  bench.give(0x000, {0x82, 0x03});
  EXPECT_EQ(bench.statusword() & kReferencedBit, kReferencedBit);
}

TEST_F(Homing, PowerOnAndALostReferenceNeedHomingAgain) {
  home();
  bench.drive.lose_reference();
  EXPECT_EQ(bench.statusword() & (kReferencedBit | kAttained), 0);
  home();
  EXPECT_EQ(bench.statusword() & kReferencedBit, kReferencedBit);
  bench.drive.power_off();
  bench.drive.power_on(bench.now_us);
  EXPECT_EQ(bench.statusword() & kReferencedBit, 0);
}

TEST_F(Homing, PowerOnClearsTheOffset) {
  bench.offset(4444);
  bench.sync();
  EXPECT_EQ(bench.read(0x60B0, 0), 4444U);
  bench.drive.power_off();
  bench.drive.power_on(bench.now_us);
  EXPECT_EQ(bench.read(0x60B0, 0), 0U);
  EXPECT_EQ(bench.drive.offset_taken(), 0);
}

}  // namespace
}  // namespace volcomp::sim
