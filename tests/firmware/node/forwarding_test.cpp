// Forwarded targets, one promise at a time (firmware/node/forwarding.hpp).

#include "tests/firmware/node/forwarding_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtCommand;

constexpr std::uint8_t kX = 1;  // sub-index, node id and source of emergencies

class NodeForwarding : public ::testing::Test {
 protected:
  // Enabled and ramped in.
  void follow() {
    bus.bring_up();
    bus.enable(true);
    bus.cycles(500);
    ASSERT_EQ(bus.bench.state(), NodeState::compensating);
    ASSERT_NE(bus.drive[0].taken->offset(), 0);
    bus.bench.emergencies.clear();
  }
  ForwardingBench bus;
};

// Way 0 and way 1 side by side: what the drive takes is the same sum, bit for bit.
TEST_F(NodeForwarding, TakesTheDriveWhereAnOffsetWouldTakeIt) {
  follow();
  NodeBench by_offset;
  by_offset.configure();
  for (std::uint8_t a = 1; a <= 3; ++a)
    ASSERT_EQ(by_offset.set<std::int32_t>(0x2202, a, bus.slew), AbortCode::none);
  by_offset.load(bench_tables());
  for (std::size_t a = 0; a < 3; ++a)
    by_offset.drive[a].target = bus.drive[a].target;
  by_offset.nmt(NmtCommand::start);
  by_offset.cycles(500);
  ASSERT_EQ(by_offset.state(), NodeState::compensating);
  test::Random random(77);
  for (int i = 0; i < 2000; ++i) {
    const auto by = static_cast<std::int32_t>(random.integer(-300'000, 300'000));
    bus.move(by);
    for (BenchDrive& d : by_offset.drive)
      d.target += by;
    bus.cycle();
    by_offset.cycle();
    ASSERT_FALSE(HasFatalFailure());
    for (std::size_t a = 0; a < 3; ++a) {
      ASSERT_TRUE(bus.drive[a].waits);
      EXPECT_EQ(bus.drive[a].waits->sent, by_offset.drive[a].target + by_offset.drive[a].next);
    }
  }
}

// 2037h: a drive that is not mapped for it would take a target for an offset.
TEST_F(NodeForwarding, SendsNothingToADriveWhoseMappingNobodyHasRead) {
  bus.configure();
  bus.bench.load(bench_tables());
  bus.start();
  bus.enable(true);
  bus.cycles(50);
  EXPECT_EQ(bus.frames(), 0);
  EXPECT_TRUE(bus.bit15());
  bus.confirm_mapping();
  bus.cycles(50);
  EXPECT_EQ(bus.frames(), 0) << "and none that was not seen disabled";
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::offset_not_confirmed, kX));
  bus.enable(false);
  bus.cycles(20);
  EXPECT_EQ(bus.frames(), 3);
  EXPECT_FALSE(bus.bit15());
}

TEST_F(NodeForwarding, ForgetsTheMappingOfADriveThatBoots) {
  follow();
  bus.bench.give({0x701, 1, {5}});
  bus.cycles(2);
  EXPECT_EQ(bus.frames(), 3);
  bus.bench.give({0x701, 1, {0}});
  EXPECT_EQ(bus.bench.number(0x2037, kX), 255U);
  bus.cycles(2);
  EXPECT_EQ(bus.frames(), 2) << "the others go on";
  EXPECT_EQ(bus.bench.set<std::uint8_t>(0x2037, kX, 1), AbortCode::device_state)
      << "it is not OPERATIONAL";
  bus.enable(false);
  bus.bench.give({0x701, 1, {5}});
  ASSERT_EQ(bus.bench.set<std::uint8_t>(0x2037, kX, 1), AbortCode::none);
  bus.cycles(2);
  EXPECT_EQ(bus.frames(), 3);
}

// A heartbeat that is only late must not stop an axis.
TEST_F(NodeForwarding, GoesOnWithoutHeartbeatOfTheDrive) {
  bus.configure();
  ASSERT_EQ(bus.bench.set<std::uint32_t>(0x1016, 1, 1U << 16U | 10U), AbortCode::none);
  bus.bench.load(bench_tables());
  bus.confirm_mapping();
  bus.start();
  bus.cycles(20);
  bus.enable(true);
  bus.cycles(500);
  bus.bench.give({0x701, 1, {5}});
  bus.cycles(100);
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::heartbeat, kX));
  EXPECT_EQ(bus.frames(), 3);
  EXPECT_NE(bus.drive[0].taken->offset(), 0);
}

TEST_F(NodeForwarding, PassesTargetsOnWithoutTables) {
  bus.configure();
  bus.confirm_mapping();
  bus.start();
  bus.cycles(10);
  bus.enable(true);
  for (int i = 0; i < 100; ++i) {
    bus.move(1000);
    bus.cycle();
    ASSERT_EQ(bus.frames(), 3);
    ASSERT_EQ(bus.drive[0].waits->offset(), 0);
  }
  EXPECT_EQ(bus.bench.state(), NodeState::no_tables);
}

// A target without one of the controller there is none; nor is one repeated.
TEST_F(NodeForwarding, SendsNothingWhereTheControllerIsSilent) {
  follow();
  const std::uint64_t before = bus.bench.number(0x2603, 0);
  bus.controller_speaks = false;
  bus.cycles(5);
  EXPECT_EQ(bus.frames(), 0);
  EXPECT_GE(bus.bench.number(0x2603, 0), before + 4 * 3);
  EXPECT_TRUE(bus.bit15());
  bus.controller_speaks = true;
  bus.cycles(2);
  EXPECT_EQ(bus.frames(), 3) << "that was not a gap of the node";
}

// The offset is ramped down meanwhile, but the drive holds what it was sent last.
TEST_F(NodeForwarding, GoesOnFromTheOffsetThatWasSentLast) {
  bus.slew = 700;
  bus.soft_rate = 700;
  bus.bring_up();
  bus.enable(true);
  bus.cycles(1000);
  const std::int32_t held = bus.drive[0].taken->offset();
  ASSERT_GT(std::abs(held), 10 * bus.slew);
  bus.controller_speaks = false;
  bus.cycles(300);
  ASSERT_NE(bus.bench.number(0x2601, kX) & kDropped, 0U);
  bus.controller_speaks = true;
  bus.cycles(1000);  // judged by the bench
  EXPECT_EQ(bus.drive[0].taken->offset(), held);
}

// Homing in the drive: "operation enabled", but the mode is another. Nothing is added meanwhile,
// and the controller begins from 6064h.
TEST_F(NodeForwarding, AddsNothingWhileADriveHomes) {
  follow();
  bus.home(true);
  bus.cycles(20);
  EXPECT_EQ(bus.frames(), 3);
  EXPECT_EQ(bus.drive[0].waits.value_or(ForwardedTarget{0, 1}).offset(), 0);
  bus.home(false);
  bus.cycles(500);  // judged by the bench
  EXPECT_NE(bus.drive[0].taken->offset(), 0);
}

// The status that would have told is lost: a controller that enables sets its target to 6064h.
TEST_F(NodeForwarding, BeginsAnewWhereNoStatusToldOfADisable) {
  follow();
  const std::int64_t before = bus.drive[0].taken->offset();
  bus.drives_speak = false;
  bus.enable(false);
  bus.cycle();
  ASSERT_TRUE(bus.drive[0].waits);
  EXPECT_EQ(bus.drive[0].waits->offset(), before) << "the drive may not have heard it";
  for (FollowingDrive& d : bus.drive)
    d.waits.reset();  // it has heard it, and takes nothing
  bus.enable(true);
  bus.cycle();
  for (const FollowingDrive& d : bus.drive) {
    ASSERT_TRUE(d.waits);
    EXPECT_EQ(d.waits->offset(), 0);
  }
}

// Enabled without reference the drive follows all the same: the offset must not jump.
TEST_F(NodeForwarding, RampsDownWhereAFollowingDriveLosesItsReference) {
  follow();
  const std::int32_t before = bus.drive[0].taken->offset();
  for (FollowingDrive& d : bus.drive)
    d.referenced = false;
  bus.cycles(3);
  EXPECT_NEAR(bus.drive[0].taken->offset(), before, 4'000) << "2203h is 1 um a cycle";
  bus.cycles(500);
  EXPECT_EQ(bus.drive[0].taken->offset(), 0);
  EXPECT_EQ(bus.frames(), 3);
}

// 50 ms that the node stood still: 25 cycles of targets wait, and none of them may leave.
TEST_F(NodeForwarding, EndsAfterItStoodStill) {
  follow();
  bus.stall(true);
  bus.forget_heartbeats();
  for (int i = 0; i < 25; ++i) {
    bus.move(2'000'000);  // 1 m/s
    bus.cycle();
  }
  bus.stall(false);
  bus.cycles(10);
  EXPECT_EQ(bus.frames(), 0);
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::forwarding_ended, 0));
  EXPECT_FALSE(bus.heartbeat_seen());
  EXPECT_TRUE(bus.bit15());
  bus.enable(false);
  bus.cycles(20);
  EXPECT_TRUE(bus.heartbeat_seen());
  bus.enable(true);
  bus.cycles(200);
  EXPECT_EQ(bus.frames(), 3);
}

// Up to 2200h:04 cycles are no more than what a bus may do.
TEST_F(NodeForwarding, GoesOnAfterAShortGap) {
  follow();
  for (int gap = 1; gap <= 2; ++gap) {
    bus.stall(true);
    bus.cycles(gap);
    bus.stall(false);
    bus.cycles(10);
    EXPECT_EQ(bus.frames(), 3) << gap;
  }
}

TEST_F(NodeForwarding, EndsWithFramesLostAndBusOff) {
  for (const bool off : {false, true}) {
    bus.restart_node();
    bus.enable(false);
    bus.cycles(20);
    bus.enable(true);
    bus.cycles(50);
    ASSERT_EQ(bus.frames(), 3);
    if (off)
      bus.bench.node->bus_state(hal::CanBusState::off);
    else
      bus.bench.node->frames_lost(1);
    bus.cycles(2);
    EXPECT_EQ(bus.frames(), 0);
    EXPECT_TRUE(bus.bench.emergency(ErrorCode::forwarding_ended, 0));
  }
}

// A port that takes nothing: what waits is replaced, and after its SYNC withdrawn.
TEST_F(NodeForwarding, EndsWhereNothingLeaves) {
  follow();
  bus.bench.port_full = true;
  bus.cycles(10);
  bus.bench.port_full = false;
  bus.cycles(2);
  EXPECT_EQ(bus.frames(), 0);
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::forwarding_ended, 0));
  EXPECT_NE(bus.bench.number(0x1001, 0), 0U);
  bus.enable(false);
  bus.bench.nmt(NmtCommand::enter_pre_operational);
  bus.start();
  bus.cycles(120);
  EXPECT_EQ(bus.frames(), 3);
  EXPECT_FALSE(bus.bench.node->device().emergency().active(ErrorCode::forwarding_ended, 0));
}

// 2208h: drives that can watch one node only learn that the controller is gone.
TEST_F(NodeForwarding, HeartbeatEndsWithTheTargetsWhereItIsAskedTo) {
  for (const std::uint8_t option : {std::uint8_t{0}, std::uint8_t{1}}) {
    bus.restart_node();
    bus.bench.nmt(NmtCommand::enter_pre_operational);
    ASSERT_EQ(bus.bench.set<std::uint8_t>(0x2208, 0, option), AbortCode::none);
    bus.enable(false);
    bus.start();
    bus.controller_speaks = true;
    bus.cycles(20);
    bus.enable(true);
    bus.cycles(50);
    bus.controller_speaks = false;
    bus.cycles(15);
    bus.forget_heartbeats();
    bus.cycles(10);
    EXPECT_EQ(bus.heartbeat_seen(), option == 0);
    bus.controller_speaks = true;
    bus.cycles(5);
    EXPECT_TRUE(bus.heartbeat_seen());
  }
}

// Somebody else gives the drive its target: it stands where that says, not where the offset is.
TEST_F(NodeForwarding, FindsADriveThatDoesNotHearIt) {
  follow();
  ASSERT_GT(std::abs(bus.drive[0].taken->offset()), bus.slew) << "it is looked for";
  bus.drive[0].unmoved = true;
  bus.cycles(150);
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::offset_not_confirmed, 1));
  EXPECT_FALSE(bus.bench.emergency(ErrorCode::offset_not_confirmed, 2));
  bus.cycles(500);
  EXPECT_EQ(bus.drive[0].waits->offset(), 0);
}

TEST_F(NodeForwarding, RefusesASecondSyncProducerWithoutCounterOnlyAsCycle) {
  bus.counts_sync = false;
  follow();
  for (int i = 0; i < 20; ++i) {
    bus.cycle();
    bus.bench.now_us += 100;
    bus.bench.give(bench_frame(0x080, 0));
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_EQ(bus.frames(), 3);
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::foreign_sync, 0));
}

// --- settings

// A synchronous RPDO would be applied a cycle late; an old target must not be repeated; a heartbeat
// of the controller that is late must not stop the axis.
TEST_F(NodeForwarding, RefusesToStartWithWhatWouldDelayOrRepeatTargets) {
  struct Setting {
    std::uint16_t index;
    std::uint8_t sub;
    std::uint64_t bad;
    std::uint64_t good;
    int bytes;
  };
  constexpr std::uint16_t kActualOfX = 0x1400 + kNodeAxes;
  const std::vector<Setting> settings{{0x1400, 2, 1, 254, 1},
                                      {kActualOfX, 2, 1, 254, 1},
                                      {0x1400, 1, 0x8000'0201U, 0x201U, 4},
                                      {0x1800, 1, 0xC000'0301U, 0x4000'0301U, 4},
                                      {0x1029, 1, 0, 1, 1}};
  bus.configure();
  bus.bench.load(bench_tables());
  bus.confirm_mapping();
  const auto write = [&](const Setting& s, std::uint64_t value) {
    Bytes bytes(static_cast<std::size_t>(s.bytes));
    store_le(bytes.data(), bytes.size(), value);
    ASSERT_EQ(bus.bench.write({s.index, s.sub}, bytes), AbortCode::none) << std::hex << s.index;
  };
  for (const Setting& s : settings) {
    write(s, s.bad);
    bus.start();
    bus.cycles(10);
    EXPECT_EQ(bus.frames(), 0) << std::hex << s.index;
    EXPECT_EQ(static_cast<Reason>(bus.bench.number(0x2112, 2)), Reason::bad_setting);
    bus.bench.nmt(NmtCommand::enter_pre_operational);
    write(s, s.good);
  }
  bus.start();
  bus.cycles(10);
  EXPECT_EQ(bus.frames(), 3);
}

TEST_F(NodeForwarding, TakesNoStartOffset) {
  bus.configure();
  EXPECT_EQ(bus.bench.set<std::int32_t>(0x2206, kX, 100), AbortCode::device_state);
}

TEST_F(NodeForwarding, WaysSetThePdosOfTheirAxis) {
  NodeBench node;
  node.configure();
  constexpr std::uint16_t kHeldOfX = 0x1400 + kFirstHeldPdo;
  ASSERT_EQ(node.set<std::uint8_t>(0x2034, kX, 1), AbortCode::none);
  EXPECT_EQ(node.number(kHeldOfX, 1), 0x8000'0481U) << "a TPDO4 of the drive is no report";
  EXPECT_EQ(node.number(kHeldOfX + 1, 1), 0x482U);
  EXPECT_EQ(node.number(0x1A00, 1), 0x2021'0120U);
  EXPECT_EQ(node.number(0x1A01, 1), 0x2020'0220U);
  EXPECT_EQ(node.number(0x1600 + kNodeAxes, 3), 0x201B'0108U);
  EXPECT_EQ(node.set<std::uint8_t>(0x2034, kX, 2), AbortCode::invalid_value);
  EXPECT_EQ(node.set<std::uint8_t>(0x2034, kX, 5), AbortCode::value_too_high);
  for (std::uint8_t a = 1; a <= 3; ++a)
    ASSERT_EQ(node.set<std::uint8_t>(0x2034, a, 3), AbortCode::none);
  EXPECT_EQ(node.number(0x1800, 1), 0x4000'027FU) << "RPDO1 of the controller";
  EXPECT_EQ(node.number(0x1A00, 0), 2U);
  EXPECT_EQ(node.number(0x1A00, 1), 0x2020'0120U);
  EXPECT_EQ(node.number(0x1A00, 2), 0x2020'0220U);
  EXPECT_NE(node.number(0x1801, 1) & 0x8000'0000U, 0U);
  EXPECT_EQ(node.number(0x1802, 1), 0x4000'037FU);
  ASSERT_EQ(node.set<std::uint8_t>(0x2034, kX, 0), AbortCode::none);
  EXPECT_EQ(node.number(0x1801, 1), 0x4000'027FU);
  EXPECT_EQ(node.number(0x1800, 1), 0x4000'0301U);
}

// --- the end of INTEGER32

// A linear axis far beyond its table, where the offset of its end would carry the sum over.
TEST_F(NodeForwarding, CutsTheSumAtTheEndOfTheRange) {
  follow();
  const bool up = bus.drive[0].taken->offset() > 0;
  const std::int32_t end = up ? INT32_MAX : INT32_MIN;
  while (bus.drive[0].target != end) {
    // Slowly where the offset is cut: what is cut is missing in the step of the drive.
    const bool near = std::abs(std::int64_t{end} - bus.drive[0].target) <= 5'000'000;
    const std::int32_t step = near ? 10'000 : 5'000'000;
    const std::int64_t next = std::int64_t{bus.drive[0].target} + (up ? step : -step);
    bus.drive[0].target = static_cast<std::int32_t>(
        std::max<std::int64_t>(INT32_MIN, std::min<std::int64_t>(INT32_MAX, next)));
    bus.cycle();
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_NE(bus.bench.node->objects().offset[0], 0) << "or nothing is to be cut";
  EXPECT_EQ(bus.drive[0].waits->sent, end);
  bus.cycle();
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::axis_clamped, kX));
}

}  // namespace
}  // namespace volcomp::node
