// Touch probe 1: what is latched, when, and how it reaches the bus.

#include <gtest/gtest.h>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

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
  bench.drive.probe_edge(true, 250'000);
  EXPECT_EQ(bench.read(0x60B9, 0), 0x0003U);
  EXPECT_EQ(bench.read(0x60BA, 0), 0xFFFF'FFFEU);
  EXPECT_EQ(bench.read(0x60D1, 0), 250'000U);
  EXPECT_EQ(bench.read(0x60D5, 0) & 0xFFFFU, 1U);
}

// What happened before a SYNC is among the answers to it, once.
TEST_F(TouchProbe, TheLatchGoesOutWithTheAnswersToTheSyncAfterIt) {
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.sync();
  bench.drive.probe_edge(true, 250'000);
  bench.wait(100);
  EXPECT_EQ(bench.find(0x283), frame(0x283, {0xFE, 0xFF, 0xFF, 0xFF, 0x90, 0xD0, 0x03, 0x00}));
  EXPECT_EQ(bench.find(0x383), frame(0x383, {0x01, 0x00, 0x00, 0x00, 0x00, 0x00}));
  bench.sync();
  EXPECT_EQ(bench.count(0x283), 0U);
  EXPECT_EQ(bench.count(0x383), 0U);
}

TEST_F(TouchProbe, AnEdgeOfTheNextPeriodGoesOutAtItsEnd) {
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.sync();
  bench.drive.probe_edge(true, 1'000'040);
  bench.wait(100);
  EXPECT_EQ(bench.count(0x283), 0U);
  EXPECT_EQ(bench.count(0x383), 0U);
  bench.sync();
  EXPECT_EQ(bench.find(0x283), frame(0x283, {0xFE, 0xFF, 0xFF, 0xFF, 0x28, 0x00, 0x00, 0x00}));
}

// Steady motion of 20 000 nm per period: the position is that share of the way, the time a multiple
// of 20 ns, both so late as the input is slow.
TEST(TouchProbeInMotion, LatchesWhereTheAxisWasThen) {
  struct Case {
    std::int64_t delay_ns, edge_ns, latch_ns;
  };
  for (const Case& c : {Case{0, 0, 0}, Case{0, 250'000, 250'000}, Case{4'000, 250'000, 254'000},
                        Case{8'000, 333'335, 341'340}, Case{2'010, 600'007, 602'020}}) {
    auto settings = Bench::node_three();
    settings.latch_delay_ns = c.delay_ns;
    Bench bench(settings);
    bench.enable();
    bench.write(0x60B8, 0, kRisingOnce, 2);
    std::int32_t target = 0;
    for (int i = 0; i < 50; ++i)
      bench.cycle(0x0F, target += 20'000);
    const std::int32_t before = bench.drive.objects().actual;
    bench.cycle(0x0F, target += 20'000);
    ASSERT_NEAR(bench.drive.objects().actual - before, 20'000, 1);
    bench.drive.probe_edge(true, c.edge_ns);
    const host::TouchProbeLatch& latch = bench.drive.objects().probe.positive_1;
    EXPECT_EQ(latch.time_ns, c.latch_ns);
    EXPECT_NEAR(latch.position, before + 0.02 * static_cast<double>(c.latch_ns), 1.0);
  }
}

TEST(TouchProbeInMotion, ALatchDelayedIntoTheNextPeriodIsTakenThere) {
  auto settings = Bench::node_three();
  settings.latch_delay_ns = 8'000;
  Bench bench(settings);
  bench.enable();
  bench.write(0x60B8, 0, kRisingOnce, 2);
  std::int32_t target = 0;
  for (int i = 0; i < 50; ++i)
    bench.cycle(0x0F, target += 20'000);
  bench.drive.probe_edge(true, 995'000);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 0);
  const std::int32_t before = bench.drive.objects().actual;
  bench.cycle(0x0F, target += 20'000);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 1);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.time_ns, 3'000U);
  EXPECT_NEAR(bench.drive.objects().probe.positive_1.position, before + 0.02 * 3'000.0, 1.0);
}

TEST_F(TouchProbe, OnlyWhatIsAskedForIsLatched) {
  bench.drive.probe_edge(true, 0);
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.drive.probe_edge(false, 0);
  EXPECT_EQ(bench.drive.objects().probe.status, 0x0001);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 0);
  EXPECT_EQ(bench.drive.objects().probe.negative_1.edge_count, 0);
}

TEST_F(TouchProbe, ASingleEventIsLatchedOnceUntilSwitchedOnAgain) {
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.drive.probe_edge(true, 0);
  bench.drive.probe_edge(true, 0);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 1);
  bench.write(0x60B8, 0, 0, 2);
  bench.write(0x60B8, 0, kRisingOnce, 2);
  bench.drive.probe_edge(true, 0);
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 2);
}

TEST_F(TouchProbe, ContinuouslyEveryEdgeCounts) {
  bench.write(0x60B8, 0, kBothContinuous, 2);
  for (int i = 0; i < 5; ++i) {
    bench.drive.probe_edge(true, 0);
    bench.drive.probe_edge(false, 100'000);
  }
  EXPECT_EQ(bench.drive.objects().probe.positive_1.edge_count, 5);
  EXPECT_EQ(bench.drive.objects().probe.negative_1.edge_count, 5);
  EXPECT_EQ(bench.read(0x60D2, 0), 100'000U);
  EXPECT_EQ(bench.read(0x60B9, 0), 0x0007U);
}

}  // namespace
}  // namespace volcomp::sim
