// What the node does with frames that are missing and values that can not be: status word 2601h,
// emergency message, counter 2610h…, and the way back.

#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::ErrorCode;

constexpr std::size_t kX = 0;
constexpr std::size_t kY = 1;
constexpr std::uint16_t kDropCycles = 10;  // 2200h:02

class NodeStatus : public ::testing::Test {
 protected:
  NodeStatus() {
    bench.bring_up();
    settled = bench.offsets();
  }

  // How often a status bit of an axis began.
  std::uint64_t began(std::size_t axis, std::uint16_t status_bit) {
    std::uint8_t sub = 1;
    while ((1U << (sub - 1U)) != status_bit)
      ++sub;
    return bench.number(static_cast<std::uint16_t>(0x2610 + axis), sub);
  }
  bool has(std::size_t axis, std::uint16_t bits) {
    return (bench.number(0x2601, static_cast<std::uint8_t>(axis + 1)) & bits) == bits;
  }
  void expect_recovery(std::size_t axis, ErrorCode code) {
    const auto source = static_cast<std::uint8_t>(axis + 1);
    EXPECT_TRUE(bench.emergency(code, source));
    bench.cycles(400);
    EXPECT_TRUE(has(axis, kValid));
    EXPECT_EQ(bench.state(), NodeState::compensating);
    EXPECT_TRUE(bench.emergency(ErrorCode::none, source));
    EXPECT_EQ(bench.number(0x1001, 0), 0U);
    EXPECT_EQ(bench.offsets(), settled);
    EXPECT_LE(bench.largest_step, 20'000);
  }

  NodeBench bench;
  std::array<std::int32_t, 3> settled{};
};

TEST_F(NodeStatus, NothingToReport) {
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_TRUE(has(a, kValid)) << a;
  EXPECT_TRUE(has(kX, kDirectionUnknown));  // has not moved yet
  EXPECT_EQ(bench.number(0x2600, 5), 0U);
}

// One missing target: held in this very cycle, over with the next frame.
TEST_F(NodeStatus, LostFrameIsStaleForItsCycle) {
  const std::uint64_t before = began(kX, kStale);
  bench.drive[kX].silent = true;
  bench.cycle();
  EXPECT_TRUE(has(kX, kStale));
  EXPECT_FALSE(has(kX, kDropped));
  EXPECT_EQ(bench.state(), NodeState::degraded);
  EXPECT_EQ(began(kX, kStale), before + 1);
  EXPECT_EQ(bench.number(0x2600, 5), 1U);  // incomplete at its deadline
  EXPECT_EQ(bench.number(0x1001, 0), 0x11U);
  bench.drive[kX].silent = false;
  bench.cycle();
  EXPECT_TRUE(has(kX, kValid));
  expect_recovery(kX, ErrorCode::rpdo_timeout);
}

// The drive still listens: its offset is held, after drop_cycles it goes to 0; the others go on.
TEST_F(NodeStatus, SilentAxisIsHeldThenDroppedTheOthersGoOn) {
  const auto lost_cycle = [this] {
    bench.sync();
    for (std::size_t a = 0; a < 3; ++a) {
      bench.offset_report(a);
      if (a != kX) bench.drive_data(a);
      if (a != kX) bench.controller_data(a);
    }
    bench.wait(NodeBench::kPeriod_us);
  };
  for (int i = 0; i < kDropCycles; ++i)
    lost_cycle();
  EXPECT_TRUE(has(kX, kStale));
  EXPECT_EQ(bench.drive[kX].held, settled[kX]);
  lost_cycle();
  EXPECT_TRUE(has(kX, kStale | kDropped));
  for (int i = 0; i < 100; ++i)
    lost_cycle();
  EXPECT_EQ(bench.drive[kX].held, 0);
  EXPECT_TRUE(has(kY, kValid));
  expect_recovery(kX, ErrorCode::rpdo_timeout);
}

TEST_F(NodeStatus, JumpOfThePositionIsImplausible) {
  bench.nmt(canopen::NmtCommand::enter_pre_operational);
  ASSERT_EQ(bench.set<std::int64_t>(0x2205, 1, 2'000'000), canopen::AbortCode::none);
  bench.nmt(canopen::NmtCommand::start);
  bench.cycles(60);
  const std::int32_t there = bench.drive[kX].target;
  bench.drive[kX].target = there + 2'000'001;
  bench.cycle();
  EXPECT_TRUE(has(kX, kImplausible | kStale));
  EXPECT_EQ(began(kX, kImplausible), 1U);
  bench.drive[kX].target = there;
  bench.cycle();
  expect_recovery(kX, ErrorCode::axis_implausible);
}

TEST_F(NodeStatus, NotReferencedGoesToZero) {
  bench.drive[kY].status = 0x0027;  // enabled, bit 8 missing
  bench.cycle();
  EXPECT_TRUE(has(kY, kNotHomed));
  bench.cycles(100);
  EXPECT_EQ(bench.drive[kY].held, 0);
  EXPECT_EQ(began(kY, kNotHomed), 1U);
  bench.drive[kY].status = 0x0127;
  expect_recovery(kY, ErrorCode::axis_not_referenced);
}

TEST_F(NodeStatus, NotEnabledCountsAsNotReferenced) {
  bench.drive[kY].status = 0x0123;  // switched on
  bench.cycle();
  EXPECT_TRUE(has(kY, kNotHomed));
  bench.drive[kY].status = 0x0127;
  expect_recovery(kY, ErrorCode::axis_not_referenced);
}

// Travel −500…0 mm, pitch 50 mm: outside stands at the end, half a pitch beyond is an alarm.
TEST_F(NodeStatus, OutOfRange) {
  const std::int32_t inside = bench.drive[kX].target;
  bench.drive[kX].target = 10'000'000;
  bench.cycles(2);
  EXPECT_TRUE(has(kX, kOutOfRange));
  EXPECT_FALSE(has(kX, kFarOutOfRange));
  EXPECT_EQ(bench.state(), NodeState::compensating);
  bench.drive[kX].target = 26'000'000;
  bench.cycles(2);
  EXPECT_TRUE(has(kX, kOutOfRange | kFarOutOfRange));
  EXPECT_EQ(bench.state(), NodeState::compensating);  // it must be possible to drive back
  EXPECT_EQ(began(kX, kFarOutOfRange), 1U);
  EXPECT_TRUE(bench.emergency(ErrorCode::axis_out_of_range, 1));
  bench.drive[kX].target = inside;
  bench.cycles(200);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_EQ(bench.number(0x1001, 0), 0U);
}

TEST_F(NodeStatus, Clamped) {
  ASSERT_GT(std::abs(settled[kX]), 100);
  bench.nmt(canopen::NmtCommand::enter_pre_operational);
  ASSERT_EQ(bench.set<std::int32_t>(0x2201, 1, 100), canopen::AbortCode::none);
  bench.nmt(canopen::NmtCommand::start);
  bench.cycles(60);
  EXPECT_EQ(std::abs(bench.drive[kX].held), 100);
  EXPECT_TRUE(has(kX, kClamped));
  EXPECT_TRUE(bench.emergency(ErrorCode::axis_clamped, 1));
  EXPECT_EQ(bench.state(), NodeState::compensating);
}

TEST_F(NodeStatus, DirectionIsUnknownUntilTheAxisMoves) {
  EXPECT_TRUE(has(kX, kDirectionUnknown));
  for (int i = 0; i < 10; ++i) {
    bench.drive[kX].target += 1000;
    bench.cycle();
  }
  EXPECT_FALSE(has(kX, kDirectionUnknown));
  EXPECT_TRUE(has(kY, kDirectionUnknown));
}

// 2016h is what the drive holds: a drive that comes back with another offset is believed.
TEST_F(NodeStatus, OffsetThatIsNotOursIsTakenOverAndLeftAtTheSlewLimit) {
  bench.drive[kX].held = bench.drive[kX].next = 300'000;  // written by another station
  bench.cycle();
  EXPECT_EQ(bench.state(), NodeState::degraded);
  bench.cycles(4);
  EXPECT_EQ(bench.drive[kX].held, 300'000);  // silent: nothing of ours can be under way
  expect_recovery(kX, ErrorCode::offset_not_confirmed);
}

TEST_F(NodeStatus, StatusIsToldInThePdo) {
  bench.drive[kY].status = 0x0027;
  bench.cycles(60);  // inhibit time 100 ms
  std::uint16_t told = 0;
  for (int i = 0; i < 60; ++i) {
    bench.cycle();
    for (const hal::CanFrame& f : bench.sent) {
      if (f.id == 0x180 + NodeBench::kId)
        told = static_cast<std::uint16_t>(f.data[6] | f.data[7] << 8);
    }
  }
  EXPECT_NE(told & kNotHomed, 0);
}

}  // namespace
}  // namespace volcomp::node
