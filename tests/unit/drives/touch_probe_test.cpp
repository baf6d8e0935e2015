// Touch probe 1: what is latched, when, and how it reaches the bus.

#include <gtest/gtest.h>

#include "tests/unit/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

constexpr std::uint16_t kRisingOnce = 0x0011;
constexpr std::uint16_t kBothContinuous = 0x0033;

class TouchProbe : public testing::Test {
 protected:
  TouchProbe() {
    bench.drive.stand_at(-2);
    bench.enable(-2);
  }
  Bench bench;
};

TEST_F(TouchProbe, EnablingIsAcknowledged) {
  EXPECT_EQ(bench.read(0x60B9, 0), 0U);
  ASSERT_EQ(bench.write(0x60B8, 0, kRisingOnce, 2), 0U);
  EXPECT_EQ(bench.read(0x60B9, 0), 0x0001U);
  ASSERT_EQ(bench.write(0x60B8, 0, 0x1111, 2), 0U);
  EXPECT_EQ(bench.read(0x60B9, 0), 0x0101U);
  ASSERT_EQ(bench.write(0x60B8, 0, 0, 2), 0U);
  EXPECT_EQ(bench.read(0x60B9, 0), 0U);
}

TEST_F(TouchProbe, AnEdgeLatchesPositionTimeAndCount) {
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.drive.probe_edge(true, 0.000'250);
  EXPECT_EQ(bench.read(0x60B9, 0), 0x0003U);
  EXPECT_EQ(bench.read(0x60BA, 0), 0xFFFF'FFFEU);
  EXPECT_EQ(bench.read(0x60D1, 0), 250'000U);
  EXPECT_EQ(bench.read(0x60D5, 0) & 0xFFFFU, 1U);
}

// TPDO3 at once, TPDO2 (type 0) after the next SYNC.
TEST_F(TouchProbe, TheLatchGoesOutOnTheBus) {
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.sent.clear();
  bench.drive.probe_edge(true, 0.000'250);
  bench.wait(100);
  EXPECT_EQ(bench.find(0x383), frame(0x383, {0x01, 0x00, 0x00, 0x00, 0x00, 0x00}));
  EXPECT_EQ(bench.count(0x283), 0U);
  bench.sync();
  EXPECT_EQ(bench.find(0x283), frame(0x283, {0xFE, 0xFF, 0xFF, 0xFF, 0x90, 0xD0, 0x03, 0x00}));
  bench.sync();
  EXPECT_EQ(bench.count(0x283), 0U);
}

TEST_F(TouchProbe, OnlyWhatIsAskedForIsLatched) {
  bench.drive.probe_edge(true, 0.0);
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.drive.probe_edge(false, 0.0);
  EXPECT_EQ(bench.drive.objects().probe.status, 0x0001);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 0);
  EXPECT_EQ(bench.drive.objects().probe.negative_1.edge_count, 0);
}

TEST_F(TouchProbe, ASingleEventIsLatchedOnceUntilSwitchedOnAgain) {
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.drive.probe_edge(true, 0.0);
  bench.drive.probe_edge(true, 0.0);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 1);
  bench.write(0x60B8, 0, 0, 2);
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.drive.probe_edge(true, 0.0);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 2);
}

TEST_F(TouchProbe, ContinuouslyEveryEdgeCounts) {
  bench.write(0x60B8, 0, kBothContinuous, 2);
  for (int i = 0; i < 5; ++i) {
    bench.drive.probe_edge(true, 0.0);
    bench.drive.probe_edge(false, 0.0001);
  }
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 5);
  EXPECT_EQ(bench.drive.objects().probe.negative_1.edge_count, 5);
  EXPECT_EQ(bench.read(0x60D2, 0), 100'000U);
  EXPECT_EQ(bench.read(0x60B9, 0), 0x0007U);
}

}  // namespace
}  // namespace volcomp::sim
