// The last station before a drive, seen from the bus: what never left, what strangers send, a drive
// that starts elsewhere, and bits that change.

#include <cstring>

#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtCommand;

constexpr std::int32_t kSlew = 700;
constexpr std::int32_t kSoft = 20;
constexpr std::uint8_t kSourceX = 1;  // source of emergencies

// Offsets of some thousand nanometres, with steps that are small beside them.
class NodeGate : public ::testing::TestWithParam<bool> {
 protected:
  static bool reports() { return GetParam(); }

  NodeGate() {
    bench.configure();
    const std::uint8_t reported = reports() ? 1 : 0;
    EXPECT_EQ(bench.set<std::uint8_t>(0x2200, 5, reported), AbortCode::none);
    for (std::uint8_t a = 1; a <= 3; ++a) {
      EXPECT_EQ(bench.set<std::int32_t>(0x2202, a, kSlew), AbortCode::none);
      EXPECT_EQ(bench.set<std::int32_t>(0x2203, a, kSoft), AbortCode::none);
    }
  }
  void bring_up() {
    bench.load(bench_tables());
    bench.nmt(NmtCommand::start);
    start_at(0);
    cycles(300);
    ASSERT_EQ(bench.state(), NodeState::compensating);
    ASSERT_GT(std::abs(bench.drive[0].held), 3 * kSlew);
    bench.emergencies.clear();
    bench.largest_step = 0;
  }
  // Without reports, 2206h receives what the drive holds at its start.
  void start_at(std::int32_t offset) {
    for (std::uint8_t a = 1; a <= 3 && !reports(); ++a)
      ASSERT_EQ(bench.set<std::int32_t>(0x2206, a, offset), AbortCode::none);
  }
  void cycle() {
    bench.sync();
    for (std::size_t a = 0; a < 3; ++a) {
      bench.drive_data(a);
      if (reports()) bench.offset_report(a);
      bench.controller_data(a);
    }
    bench.wait(NodeBench::kPeriod_us);
  }
  void cycles(int count) {
    for (int i = 0; i < count; ++i)
      cycle();
  }

  NodeBench bench;
};

// The port takes nothing for 200 cycles while the axes travel; then it takes everything.
TEST_P(NodeGate, WhatNeverLeftAllowsNoStep) {
  bring_up();
  for (int round = 0; round < 4; ++round) {
    bench.port_full = true;
    const std::int32_t before = bench.drive[0].held;
    for (int i = 0; i < 200; ++i) {
      for (BenchDrive& d : bench.drive)
        d.target += round % 2 == 0 ? 400'000 : -400'000;
      cycle();
    }
    EXPECT_EQ(bench.drive[0].held, before);
    bench.port_full = false;
    cycles(300);
    EXPECT_LE(bench.largest_step, kSlew);
    EXPECT_GT(std::abs(bench.drive[0].held - before), 2 * kSlew) << "or there was nothing to step";
  }
}

// 480h + n is the identifier of the report: another sender uses it.
TEST_P(NodeGate, StrangersCloseItOnlyWhereReportsCount) {
  bring_up();
  bench.give({0x481, 4, {0x11, 0x22, 0x33, 0x00}});
  cycle();
  EXPECT_EQ(bench.state(), reports() ? NodeState::degraded : NodeState::compensating);
  EXPECT_EQ(bench.emergency(ErrorCode::offset_not_confirmed, kSourceX), reports());
}

// Not the gate alone turns a deaf ear: the PDO is off, and on again with the reports.
TEST(NodeGatePdo, OfReportsIsOffWhereDrivesDoNotReport) {
  constexpr std::uint16_t kHeldOfX = 0x1400 + kFirstHeldPdo;
  NodeBench bench;
  bench.configure();
  EXPECT_EQ(bench.number(kHeldOfX, 1), 0x481U);
  ASSERT_EQ(bench.set<std::uint8_t>(0x2200, 5, 0), AbortCode::none);
  EXPECT_EQ(bench.number(kHeldOfX, 1), 0x8000'0481U);
  ASSERT_EQ(bench.set<std::uint8_t>(0x2010, kSourceX, 7), AbortCode::none);
  EXPECT_EQ(bench.number(kHeldOfX, 1), 0x8000'0487U);
  ASSERT_EQ(bench.set<std::uint8_t>(0x2200, 5, 1), AbortCode::none);
  EXPECT_EQ(bench.number(kHeldOfX, 1), 0x487U);
}

// 2207h says it axis by axis, 2200h:05 for all.
TEST(NodeGatePdo, OfReportsIsThatOfItsAxis) {
  constexpr std::uint16_t kHeldOfX = 0x1400 + kFirstHeldPdo;
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(kHeldOfX + 1, 1, 0x8000'0482U), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint8_t>(0x2207, kSourceX, 0), AbortCode::none);
  EXPECT_EQ(bench.number(kHeldOfX, 1), 0x8000'0481U);
  EXPECT_EQ(bench.number(kHeldOfX + 1, 1), 0x8000'0482U) << "that of Y stays as it was set";
  ASSERT_EQ(bench.set<std::uint8_t>(0x2200, 5, 0), AbortCode::none);
  for (std::uint8_t a = 1; a <= kNodeAxes; ++a)
    EXPECT_EQ(bench.number(0x2207, a), 0U);
  ASSERT_EQ(bench.set<std::uint8_t>(0x2200, 5, 1), AbortCode::none);
  EXPECT_EQ(bench.number(0x2207, kSourceX), 1U);
  EXPECT_EQ(bench.number(kHeldOfX, 1), 0x481U);
  EXPECT_EQ(bench.set<std::uint8_t>(0x2207, kSourceX, 2), AbortCode::value_too_high);
}

// X cannot report: its start is given, the others report theirs; nobody waits for X.
TEST(NodeGateMixed, EachAxisStartsAsItsDriveCan) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint8_t>(0x2207, kSourceX, 0), AbortCode::none);
  bench.load(bench_tables());
  for (BenchDrive& d : bench.drive)
    d.held = d.next = 500;
  bench.nmt(NmtCommand::start);
  const auto cycle = [&bench] {
    bench.sync();
    for (std::size_t a = 0; a < 3; ++a) {
      bench.drive_data(a);
      if (a != 0) bench.offset_report(a);
      bench.controller_data(a);
    }
    bench.wait(NodeBench::kPeriod_us);
  };
  for (int i = 0; i < 20; ++i)
    cycle();
  EXPECT_EQ(bench.state(), NodeState::waiting) << "for the start of X";
  ASSERT_EQ(bench.set<std::int32_t>(0x2206, kSourceX, 500), AbortCode::none);
  bench.largest_step = 0;
  for (int i = 0; i < 300; ++i)
    cycle();
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_LE(bench.largest_step, 20'000) << "2202h";
  EXPECT_EQ(bench.node->objects().deadline_missed, 0U) << "no cycle waits for a report of X";
}

// A drive that has come back with 0 and is as enabled as before: the compensator stands where it
// stood.
TEST_P(NodeGate, FromWhatADriveHoldsTheWayIsSoft) {
  constexpr std::uint32_t kHeartbeatOfX = 1U << 16U | 60'000U;
  ASSERT_EQ(bench.set<std::uint32_t>(0x1016, 1, kHeartbeatOfX), AbortCode::none);
  bring_up();
  bench.give({0x701, 1, {5}});
  const std::int32_t before = bench.drive[0].held;
  bench.give({0x701, 1, {0}});  // boot-up
  bench.drive[0].held = bench.drive[0].next = 0;
  if (!reports()) {
    ASSERT_EQ(bench.set<std::int32_t>(0x2206, kSourceX, 0), AbortCode::none);
  }
  std::int32_t largest = 0;
  for (int i = 0; i < 20 + std::abs(before) / kSoft; ++i) {
    const std::int32_t held = bench.drive[0].held;
    cycle();
    largest = std::max(largest, std::abs(bench.drive[0].held - held));
  }
  EXPECT_EQ(bench.drive[0].held, before);
  EXPECT_EQ(largest, kSoft);
}

// What a scale makes of an offset can be anything; the drive gets no more than 2201h, in no larger
// steps than 2202h, and the node reports which axis it is.
TEST_P(NodeGate, AFlippedBitOfAScaleWalksToZero) {
  constexpr std::uint32_t kOneToOne = 123'457;
  constexpr std::int32_t kLimit = 150'000;
  ASSERT_EQ(bench.set<std::uint32_t>(0x2030, kSourceX, kOneToOne), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint32_t>(0x2031, kSourceX, kOneToOne), AbortCode::none);
  ASSERT_EQ(bench.set<std::int32_t>(0x2201, kSourceX, kLimit), AbortCode::none);
  ASSERT_EQ(bench.set<std::int32_t>(0x2203, kSourceX, kSlew), AbortCode::none);
  bring_up();
  const std::array<std::uint32_t, 2> scale{kOneToOne, kOneToOne};
  auto* const memory = reinterpret_cast<unsigned char*>(bench.node.get());
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i + sizeof scale <= sizeof(Node); i += sizeof scale[0]) {
    if (std::memcmp(memory + i, scale.data(), sizeof scale) == 0) places.push_back(i);
  }
  ASSERT_EQ(places.size(), 2U) << "held twice";
  for (unsigned bit = 0; bit < 64; bit += 5) {
    SCOPED_TRACE(bit);
    memory[places[bit % 2] + bit / 8] ^= static_cast<unsigned char>(1U << bit % 8);
    for (int i = 0; i < 700; ++i) {
      cycle();
      ASSERT_LE(std::abs(bench.drive[0].held), kLimit);
    }
    EXPECT_LE(bench.largest_step, kSlew);
    EXPECT_EQ(bench.drive[0].held, 0);
    EXPECT_TRUE(bench.emergency(ErrorCode::memory_damaged, kSourceX));
    EXPECT_EQ(bench.state(), NodeState::no_tables) << "no axis goes on with a wrong position";
    // A new start takes the settings anew.
    bench.nmt(NmtCommand::enter_pre_operational);
    ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
    bench.nmt(NmtCommand::start);
    start_at(0);
    cycles(300);
    ASSERT_EQ(bench.state(), NodeState::compensating);
    EXPECT_TRUE(bench.emergency(ErrorCode::none, kSourceX));
    bench.emergencies.clear();
    bench.largest_step = 0;
  }
}

INSTANTIATE_TEST_SUITE_P(Reports, NodeGate, ::testing::Bool(), [](const auto& kind) {
  return std::string(kind.param ? "Confirmed" : "Unconfirmed");
});

}  // namespace
}  // namespace volcomp::node
