// 2209h, seen by the drives: the step of an offset changes by no more than that in a cycle.

#include <cstring>

#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtCommand;

constexpr std::int32_t kAcceleration = 20;
constexpr std::int32_t kSlew = 7'000;  // corrections have a seventh of it

struct LargestChanges {
  std::int32_t step = 0;
  std::int32_t of_step = 0;
};

class NodeAcceleration : public ::testing::Test {
 protected:
  void bring_up(std::int32_t acceleration) {
    bench_.configure();
    for (std::uint8_t a = 1; a <= NodeBench::kDrives; ++a) {
      EXPECT_EQ(bench_.set<std::int32_t>(0x2202, a, kSlew), AbortCode::none);
      EXPECT_EQ(bench_.set<std::int32_t>(0x2209, a, acceleration), AbortCode::none);
    }
    bench_.load(bench_tables());
    bench_.nmt(NmtCommand::start);
  }
  void move(int n) {
    for (BenchDrive& d : bench_.drive)
      d.target += n / 200 % 2 == 0 ? 150'000 : -150'000;
    bench_.cycle();
  }
  // Axes that travel to and fro, tables that come and go.
  LargestChanges travel() {
    LargestChanges largest;
    std::array<std::int32_t, NodeBench::kDrives> held{};
    std::array<std::int32_t, NodeBench::kDrives> step{};
    for (int n = 0; n < 3'000; ++n) {
      if (n == 1'500) {
        EXPECT_EQ(bench_.command(TableCommand::deactivate), AbortCode::none);
      }
      move(n);
      for (std::size_t a = 0; a < NodeBench::kDrives; ++a) {
        const std::int32_t moved = bench_.drive.at(a).held - held.at(a);
        largest.step = std::max(largest.step, std::abs(moved));
        largest.of_step = std::max(largest.of_step, std::abs(moved - step.at(a)));
        step.at(a) = moved;
        held.at(a) = bench_.drive.at(a).held;
      }
    }
    return largest;
  }

  NodeBench bench_;
};

TEST_F(NodeAcceleration, NoStepChangesByMore) {
  bring_up(kAcceleration);
  const LargestChanges largest = travel();
  EXPECT_LE(largest.of_step, kAcceleration);
  EXPECT_GT(largest.step, 3 * kAcceleration) << "or there was nothing to be limited";
  EXPECT_GT(bench_.number(0x2606, 1), 0U);
}

TEST_F(NodeAcceleration, NoneIsTheDefault) {
  EXPECT_EQ(bench_.number(0x2209, 1), 0U);
  bring_up(0);
  EXPECT_GT(travel().of_step, 3 * kAcceleration);
}

// The gate finds what a flipped bit makes of the acceleration that a tick of the compensator
// compares with, which stands shortly before the bounds it was made of: X gets 0 by
// the acceleration that was set, and nothing more until the node starts anew.
TEST_F(NodeAcceleration, WhatBreaksItIsTakenToZeroAndReported) {
  constexpr std::int32_t kLimit = 123'457;
  constexpr std::uint8_t kSourceX = 1;
  ASSERT_EQ(bench_.set<std::int32_t>(0x2201, kSourceX, kLimit), AbortCode::none);
  bring_up(kAcceleration);
  for (int n = 0; n < 350; ++n)
    move(n);
  // What the tick compares with: the acceleration comes first, the limit as the eighth word.
  constexpr std::size_t kToLimit = 7 * sizeof kLimit;
  const auto holds = [](const unsigned char* at, std::int32_t value) {
    return std::memcmp(at, &value, sizeof value) == 0;
  };
  auto* memory = reinterpret_cast<unsigned char*>(bench_.node.get());
  const auto* const end = memory + sizeof(Node) - kToLimit - sizeof kLimit;
  while (memory < end && !(holds(memory, kAcceleration) && holds(memory + kToLimit, kLimit)))
    memory += sizeof kLimit;
  ASSERT_LT(memory, end);
  memory[1] ^= 0x10U;
  std::int32_t held = bench_.drive[0].held;
  std::int32_t step = 0;
  for (int n = 350; n < 1'500; ++n) {
    move(n);
    const std::int32_t moved = bench_.drive[0].held - held;
    if (n > 350) {
      ASSERT_LE(std::abs(moved - step), kAcceleration + 2) << n;
    }
    step = moved;
    held = bench_.drive[0].held;
  }
  EXPECT_EQ(held, 0);
  EXPECT_TRUE(bench_.emergency(ErrorCode::correction_jumped, kSourceX));
  EXPECT_FALSE(bench_.emergency(ErrorCode::correction_jumped, kSourceX + 1));
}

// Bit 14 of the status, and how often it began: sub-index 15 of 2610h.
TEST_F(NodeAcceleration, IsReportedAndCounted) {
  bring_up(kAcceleration);
  std::uint32_t seen = 0;
  for (int n = 0; n < 100; ++n) {
    bench_.cycle();
    seen |= bench_.status(0);
  }
  EXPECT_NE(seen & kAccelerationLimited, 0U);
  EXPECT_GT(bench_.number(0x2610, 15), 0U);
}

TEST_F(NodeAcceleration, IsRefusedOutsideItsRangeAndInOperation) {
  EXPECT_EQ(bench_.set<std::int32_t>(0x2209, 1, -1), AbortCode::value_too_low);
  EXPECT_EQ(bench_.set<std::int32_t>(0x2209, 1, 16'777'217), AbortCode::value_too_high);
  EXPECT_EQ(bench_.set<std::int32_t>(0x2209, 1, 16'777'216), AbortCode::none);
  bring_up(kAcceleration);
  EXPECT_EQ(bench_.set<std::int32_t>(0x2209, 1, 1), AbortCode::device_state);
}

}  // namespace
}  // namespace volcomp::node
