// Following error: fault, EMCY 8611h, fault reaction, reset.

#include <gtest/gtest.h>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

class DriveFault : public testing::Test {
 protected:
  DriveFault() : bench(settings()) { bench.enable(); }
  static Cia402Drive::Settings settings() {
    auto s = Bench::node_three();
    s.following_window = 1000;
    return s;
  }
  Bench bench;
};

// After one period e^(−1/2) of a step is left.
TEST_F(DriveFault, TheWindowItselfIsAllowed) {
  bench.cycle(0x0F, 1648);  // 999.6 nm left, read as 1000
  EXPECT_EQ(bench.drive.objects().following_error, 1000);
  EXPECT_EQ(bench.statusword() & 0x006F, 0x0027);
  EXPECT_EQ(bench.find(0x083).size, 0);
}

TEST_F(DriveFault, BeyondTheWindowItFailsWith8611) {
  bench.cycle(0x0F, 1650);
  const hal::CanFrame emergency = bench.find(0x083);
  ASSERT_EQ(emergency.size, 8);
  EXPECT_EQ(emergency.data[0] | emergency.data[1] << 8, 0x8611);
  EXPECT_EQ(emergency.data[2] & 0x01, 0x01);  // generic error
  EXPECT_EQ(bench.statusword() & 0x004F, 0x000F);
  EXPECT_EQ(bench.statusword() & 0x2000, 0x2000);  // following error of this mode
  bench.cycle(0x0F, 1650);
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0008);
  EXPECT_EQ(bench.read(0x603F, 0), 0x8611U);
  EXPECT_EQ(bench.read(0x1001, 0) & 0x01U, 0x01U);
}

TEST_F(DriveFault, TheAxisStaysWhereItStopped) {
  bench.cycle(0x0F, 1'000'000);
  bench.cycle(0x0F, 1'000'000);
  const double stands = bench.drive.position_units();
  for (int i = 0; i < 10; ++i)
    bench.cycle(0x0F, 1'000'000);
  EXPECT_EQ(bench.drive.position_units(), stands);
  EXPECT_EQ(bench.drive.objects().following_error, 0);
}

TEST_F(DriveFault, ResetClearsItAndSaysSo) {
  bench.cycle(0x0F, 1650);
  bench.cycle(0x0F, 1650);
  bench.cycle(0x80, 0);
  EXPECT_EQ(bench.statusword() & 0x204F, 0x0040);
  const hal::CanFrame emergency = bench.find(0x083);
  ASSERT_EQ(emergency.size, 8);
  EXPECT_EQ(emergency.data[0] | emergency.data[1] << 8, 0x0000);
  EXPECT_EQ(bench.read(0x1001, 0), 0U);
  EXPECT_EQ(bench.read(0x1003, 1) & 0xFFFFU, 0x8611U);
}

TEST_F(DriveFault, AfterTheResetItCanBeEnabledAndFailAgain) {
  bench.cycle(0x0F, 1650);
  bench.cycle(0x0F, 1650);
  bench.cycle(0x80, 0);
  const std::int32_t stands = bench.drive.objects().actual;
  bench.enable(stands);
  EXPECT_EQ(bench.statusword() & 0x106F, 0x1027);
  bench.cycle(0x0F, stands + 1650);
  EXPECT_EQ(bench.find(0x083).size, 8);
}

TEST_F(DriveFault, FaultOption0SwitchesOffAtOnce) {
  ASSERT_EQ(bench.write(0x605E, 0, 0, 2), 0U);
  bench.cycle(0x0F, 1650);
  EXPECT_EQ(bench.statusword() & 0x004F, 0x0008);
}

TEST_F(DriveFault, AWindowOfAllOnesIsNoWindow) {
  ASSERT_EQ(bench.write(0x6065, 0, 0xFFFF'FFFF, 4), 0U);
  bench.cycle(0x0F, 1'000'000'000);
  EXPECT_EQ(bench.statusword() & 0x006F, 0x0027);
}

}  // namespace
}  // namespace volcomp::sim
