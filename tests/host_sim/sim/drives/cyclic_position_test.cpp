// Cyclic synchronous position over the bus: target and offset take effect together, at SYNC.

#include <gtest/gtest.h>

#include "tests/host_sim/sim/drives/cia402_bench.hpp"

namespace volcomp::sim {
namespace {

TEST(CyclicPosition, FramesAreTheBytesOfTheStandard) {
  Bench bench;
  ASSERT_EQ(bench.sent.size(), 1U);
  EXPECT_EQ(bench.sent[0], frame(0x703, {0x00}));           // boot-up
  bench.give(0x000, {0x01, 0x03});                          // NMT start
  bench.give(0x203, {0x06, 0x00, 0x00, 0x00, 0x00, 0x00});  // shutdown
  bench.sync();
  bench.give(0x203, {0x07, 0x00, 0x00, 0x00, 0x00, 0x00});  // switch on
  bench.sync();
  bench.give(0x203, {0x0F, 0x00, 0x00, 0x00, 0x00, 0x00});  // enable operation
  bench.sync();
  bench.give(0x203, {0x0F, 0x00, 0x10, 0x27, 0x00, 0x00});  // 10 000 nm
  bench.give(0x303, {0xD6, 0xFF, 0xFF, 0xFF});              // −42 nm
  bench.sync();
  // The axis has covered 1 − e^(−1/2) of 9 958 nm, which is 3 918 = 0F4Eh.
  EXPECT_EQ(bench.find(0x183), frame(0x183, {0x4E, 0x0F, 0x00, 0x00, 0x37, 0x12, 0x00, 0x00}));
  EXPECT_EQ(bench.find(0x483), frame(0x483, {0xD6, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(bench.sent.size(), 2U);
}

TEST(CyclicPosition, NothingTakesEffectBeforeSync) {
  Bench bench;
  bench.enable();
  bench.command(0x0F, 5000);
  bench.offset(70);
  bench.wait(900);
  EXPECT_EQ(bench.drive.demand(), 0);
  EXPECT_EQ(bench.drive.objects().offset, 0);
  EXPECT_EQ(bench.drive.offset_taken(), 0);
  bench.sync();
  EXPECT_EQ(bench.drive.demand(), 5070);
  EXPECT_EQ(bench.drive.offset_taken(), 70);
}

TEST(CyclicPosition, OfSeveralOffsetsTheLatestWins) {
  Bench bench;
  bench.enable();
  bench.offset(10);
  bench.offset(20);
  bench.offset(30);
  bench.sync();
  EXPECT_EQ(bench.drive.demand(), 30);
  EXPECT_EQ(bench.find(0x483), frame(0x483, {30, 0, 0, 0}));
}

TEST(CyclicPosition, WithoutNewFramesTargetAndOffsetStay) {
  Bench bench;
  bench.enable();
  bench.offset(25);
  bench.cycle(0x0F, 1000);
  for (int i = 0; i < 100; ++i)
    bench.sync();
  EXPECT_EQ(bench.drive.demand(), 1025);
  EXPECT_EQ(bench.drive.objects().actual, 1025);
  EXPECT_EQ(bench.find(0x483), frame(0x483, {25, 0, 0, 0}));
}

TEST(CyclicPosition, EveryInputIsRecordedWithTheOffsetBefore) {
  Bench bench;
  ASSERT_EQ(bench.write(0x1019, 0, 240, 1), 0U);
  std::vector<Cia402Drive::InputStep> steps;
  bench.drive.on_input = [&steps](const Cia402Drive::InputStep& step) { steps.push_back(step); };
  bench.start_node();
  std::uint8_t counter = 0;
  const auto step = [&](std::uint16_t controlword, std::int32_t target, std::int32_t offset) {
    bench.command(controlword, target);
    bench.offset(offset);
    bench.give(0x080, {++counter});
  };
  step(0x06, 0, 5);
  step(0x07, 0, 5);
  step(0x0F, -5, 5);
  EXPECT_TRUE(steps.empty());  // enabled, but no target since
  step(0x0F, -5, 5);
  step(0x0F, 100, 7);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].previous_offset, 5);
  EXPECT_EQ(steps[1].target, 100);
  EXPECT_EQ(steps[1].offset, 7);
  EXPECT_EQ(steps[1].previous_offset, 5);
  EXPECT_EQ(steps[1].sync_counter, 5);
}

TEST(CyclicPosition, EnablingDoesNotMoveTheAxis) {
  Bench bench;
  bench.drive.stand_at(123'456);
  bench.start_node();
  bench.offset(900);
  bench.cycle(0x06, 0);
  bench.cycle(0x07, 0);
  bench.cycle(0x0F, 0);
  for (int i = 0; i < 10; ++i)
    bench.sync();
  EXPECT_EQ(bench.statusword() & 0x106F, 0x0027);  // enabled, does not follow yet
  EXPECT_EQ(bench.drive.objects().actual, 123'456);
  // Target = actual − offset keeps it there.
  bench.cycle(0x0F, 123'456 - 900);
  EXPECT_EQ(bench.statusword() & 0x106F, 0x1027);
  EXPECT_EQ(bench.drive.demand(), 123'456);
  EXPECT_EQ(bench.drive.objects().actual, 123'456);
}

TEST(CyclicPosition, WhatIsNotEnabledStandsStill) {
  Bench bench;
  bench.start_node();
  bench.cycle(0x06, 1'000'000);
  bench.cycle(0x07, 1'000'000);
  EXPECT_EQ(bench.drive.objects().actual, 0);
  bench.enable();
  bench.cycle(0x0F, 1'000'000);
  bench.cycle(0x07, 1'000'000);  // disable operation
  const std::int32_t stopped = bench.drive.objects().actual;
  bench.cycle(0x07, 1'000'000);
  EXPECT_EQ(bench.drive.objects().actual, stopped);
}

TEST(CyclicPosition, TheSumOfTargetAndOffsetSaturates) {
  auto settings = Bench::node_three();
  settings.following_window = host::kNoFollowingWindow;
  Bench bench(settings);
  bench.drive.stand_at(INT32_MAX - 10);
  bench.enable(INT32_MAX - 10);
  bench.offset(1000);
  bench.cycle(0x0F, INT32_MAX);
  EXPECT_EQ(bench.drive.demand(), INT32_MAX);
  EXPECT_EQ(bench.drive.objects().demand, INT32_MAX);
}

TEST(CyclicPosition, ASoftwareLimitHoldsTargetPlusOffset) {
  auto settings = Bench::node_three();
  settings.software_min = -1000;
  settings.software_max = 1000;
  Bench bench(settings);
  bench.enable();
  bench.cycle(0x0F, 1000);
  EXPECT_EQ(bench.drive.demand(), 1000);
  EXPECT_EQ(bench.statusword() & 0x0800, 0);
  bench.offset(1);
  bench.cycle(0x0F, 1000);
  EXPECT_EQ(bench.drive.demand(), 1000);
  EXPECT_EQ(bench.statusword() & 0x0800, 0x0800);  // internal limit active
  bench.cycle(0x0F, -1001);
  EXPECT_EQ(bench.drive.demand(), -1000);
  EXPECT_EQ(bench.statusword() & 0x0800, 0);
}

TEST(CyclicPosition, AnAxisBeyondItsLimitMayOnlyComeBack) {
  auto settings = Bench::node_three();
  settings.software_max = 1000;
  Bench bench(settings);
  bench.drive.stand_at(1500);
  bench.enable(1500);
  EXPECT_EQ(bench.drive.demand(), 1500);
  bench.cycle(0x0F, 1600);
  EXPECT_EQ(bench.drive.demand(), 1500);
  bench.cycle(0x0F, 1400);
  EXPECT_EQ(bench.drive.demand(), 1400);
  bench.cycle(0x0F, 1500);
  EXPECT_EQ(bench.drive.demand(), 1400);
}

}  // namespace
}  // namespace volcomp::sim
