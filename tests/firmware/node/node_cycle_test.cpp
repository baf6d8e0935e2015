// The cycle of the node: its deadline, its own SYNC, its partners, its process data in another
// order, drives that can not report.

#include "comp/core/bytes.hpp"
#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtCommand;
using canopen::NmtState;

std::size_t count(const std::vector<hal::CanFrame>& frames, unsigned id) {
  std::size_t n = 0;
  for (const hal::CanFrame& f : frames)
    n += f.id == id ? 1U : 0U;
  return n;
}

hal::CanFrame heartbeat(std::uint8_t node, std::uint8_t state) {
  return {static_cast<std::uint16_t>(0x700 + node), 1, {state}};
}

// --- when a cycle is computed

TEST(NodeCycle, OffsetsLeaveAsSoonAsEverythingIsThere) {
  NodeBench bench;
  bench.bring_up();
  bench.sync();
  for (std::size_t a = 0; a < 3; ++a) {
    bench.drive_data(a);
    bench.offset_report(a);
    EXPECT_EQ(count(bench.sent, 0x301), 0U);
    bench.controller_data(a);
  }
  for (unsigned a = 0; a < 3; ++a)
    EXPECT_EQ(count(bench.sent, 0x301 + a), 1U);
}

TEST(NodeCycle, DeadlineIsSixtyPercentOfThePeriod) {
  NodeBench bench;
  bench.bring_up();
  bench.drive[2].silent = true;
  const std::uint64_t missed = bench.number(0x2600, 5);
  bench.sync();
  EXPECT_EQ(bench.node->deadline_us(), bench.now_us + 1200);
  bench.drive_data(0);
  bench.offset_report(0);
  bench.controller_data(0);
  bench.wait(1100);
  EXPECT_EQ(count(bench.sent, 0x301), 0U);
  bench.wait(100);
  EXPECT_EQ(count(bench.sent, 0x301), 1U);
  EXPECT_EQ(bench.number(0x2600, 5), missed + 1);
  EXPECT_EQ(bench.node->deadline_us(), UINT64_MAX);
}

TEST(NodeCycle, DeadlineCanBeSet) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x2200, 3, 500), AbortCode::none);
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  bench.sync();
  EXPECT_EQ(bench.node->deadline_us(), bench.now_us + 500);
}

TEST(NodeCycle, NextSyncCutsAnOpenCycleShort) {
  NodeBench bench;
  bench.bring_up();
  const std::uint64_t cycles = bench.number(0x2600, 4);
  bench.sync();
  bench.wait(100);
  bench.sync();
  EXPECT_EQ(bench.number(0x2600, 6), 1U);
  EXPECT_EQ(bench.number(0x2600, 4), cycles + 1);
  bench.wait(2000);
  bench.cycles(10);
  EXPECT_EQ(bench.state(), NodeState::compensating);
}

TEST(NodeCycle, NothingIsSentBeforeTheDrivesHaveReported) {
  NodeBench bench;
  bench.configure();
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  for (int i = 0; i < 50; ++i) {
    bench.sync();
    for (std::size_t a = 0; a < 3; ++a) {
      bench.drive_data(a);
      bench.controller_data(a);
    }
    bench.wait(NodeBench::kPeriod_us);
    ASSERT_EQ(count(bench.sent, 0x301), 0U);
  }
  EXPECT_EQ(bench.state(), NodeState::waiting);
}

// A node that starts ramps from the offsets it finds, whatever they are.
TEST(NodeCycle, StartsFromTheOffsetsTheDrivesHold) {
  NodeBench bench;
  for (BenchDrive& d : bench.drive)
    d.held = d.next = 150'000;
  bench.bring_up();
  EXPECT_LE(bench.largest_step, 20'000);
  EXPECT_LT(bench.drive[0].held, 100'000);
}

// --- SYNC

TEST(NodeSync, ProducesItWhereThereIsNoController) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x1005, 0, 0x4000'0080), AbortCode::none);
  bench.nmt(NmtCommand::start);
  bench.sent.clear();
  bench.wait(10 * std::uint64_t{NodeBench::kPeriod_us});
  EXPECT_EQ(count(bench.sent, 0x080), 10U);
  std::uint8_t last = 0;
  for (const hal::CanFrame& f : bench.sent) {
    if (f.id != 0x080) continue;
    EXPECT_EQ(f.size, 1);
    EXPECT_EQ(f.data[0], last == 0 ? f.data[0] : last + 1);
    last = f.data[0];
  }
  EXPECT_GE(bench.number(0x2600, 4), 9U);
}

TEST(NodeSync, StepsBackBesideAnotherProducer) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x1005, 0, 0x4000'0080), AbortCode::none);
  bench.nmt(NmtCommand::start);
  bench.wait(5 * std::uint64_t{NodeBench::kPeriod_us});
  bench.sync();
  EXPECT_EQ(bench.number(0x1005, 0), 0x80U);
  bench.sent.clear();
  bench.wait(50'000);
  EXPECT_EQ(count(bench.sent, 0x080), 0U);
  EXPECT_TRUE(bench.emergency(ErrorCode::foreign_sync, 0));
  bench.cycles(150);  // the other one is the producer now
  EXPECT_TRUE(bench.emergency(ErrorCode::none, 0));
  EXPECT_EQ(bench.number(0x1001, 0), 0U);
}

// --- partners

TEST(NodePartners, LosingTheControllerIsACommunicationError) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x1016, 1, 127U << 16U | 300U), AbortCode::none);
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  bench.give(heartbeat(127, 5));
  bench.cycles(100);
  ASSERT_EQ(bench.node->device().state(), NmtState::operational);
  bench.cycles(60);
  // 1029h = 0: back to PRE-OPERATIONAL, the offsets stay in the drives.
  EXPECT_EQ(bench.node->device().state(), NmtState::pre_operational);
  EXPECT_EQ(bench.state(), NodeState::idle);
  EXPECT_TRUE(bench.emergency(ErrorCode::heartbeat, 127));
  const auto frozen = bench.offsets();
  bench.cycles(20);
  EXPECT_EQ(bench.offsets(), frozen);
  bench.give(heartbeat(127, 5));
  bench.nmt(NmtCommand::start);
  bench.cycles(60);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_TRUE(bench.emergency(ErrorCode::none, 127));
}

TEST(NodePartners, ErrorBehaviourOneGoesOnWithoutTheController) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x1016, 1, 127U << 16U | 300U), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint8_t>(0x1029, 1, 1), AbortCode::none);
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  bench.give(heartbeat(127, 5));
  bench.cycles(300);
  EXPECT_TRUE(bench.emergency(ErrorCode::heartbeat, 127));
  EXPECT_EQ(bench.node->device().state(), NmtState::operational);
  EXPECT_EQ(bench.state(), NodeState::compensating);
}

TEST(NodePartners, ALostDriveIsHeldThenRampedTheOthersGoOn) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x1016, 2, 2U << 16U | 50U), AbortCode::none);
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  bench.give(heartbeat(2, 5));
  bench.cycles(20);
  bench.drive[1].silent = true;
  bench.cycles(60);
  EXPECT_TRUE(bench.emergency(ErrorCode::heartbeat, 2));
  EXPECT_EQ(bench.node->device().state(), NmtState::operational);
  EXPECT_EQ(bench.state(), NodeState::degraded);
  EXPECT_NE(bench.status(1) & kDropped, 0);
  EXPECT_NE(bench.status(0) & kValid, 0);
  EXPECT_NE(bench.status(2) & kValid, 0);
  const std::int32_t x = bench.drive[0].held;
  bench.drive[0].target -= 40'000'000;
  bench.cycles(20);
  EXPECT_NE(bench.drive[0].held, x);
  // Back with 60B0h = 0, as after its power-on.
  bench.drive[1].silent = false;
  bench.drive[1].held = bench.drive[1].next = 0;
  bench.give(heartbeat(2, 0));
  bench.give(heartbeat(2, 5));
  bench.cycles(20);
  for (int i = 0; i < 300; ++i) {
    if (i % 20 == 0) bench.give(heartbeat(2, 5));
    bench.cycle();
  }
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_EQ(bench.number(0x1001, 0), 0U);
  EXPECT_LE(bench.largest_step, 20'000);
}

// --- process data

void remap(NodeBench& bench, std::uint8_t pdo, std::uint32_t cob_id,
           const std::vector<std::uint32_t>& mapping) {
  const auto communication = static_cast<std::uint16_t>(0x1400 + pdo);
  const auto map = static_cast<std::uint16_t>(0x1600 + pdo);
  ASSERT_EQ(bench.set<std::uint32_t>(communication, 1, 0x8000'0000 | cob_id), AbortCode::none);
  ASSERT_EQ(bench.set<std::uint8_t>(map, 0, 0), AbortCode::none);
  for (std::size_t i = 0; i < mapping.size(); ++i)
    ASSERT_EQ(bench.set<std::uint32_t>(map, static_cast<std::uint8_t>(i + 1), mapping[i]),
              AbortCode::none);
  ASSERT_EQ(bench.set<std::uint8_t>(map, 0, static_cast<std::uint8_t>(mapping.size())),
            AbortCode::none);
  ASSERT_EQ(bench.set<std::uint32_t>(communication, 1, cob_id), AbortCode::none);
}

// Drives of another make: status word first, then position; target in front of the control word.
TEST(NodeProcessData, AnotherMappingMarksTheAxesAsFreshToo) {
  NodeBench expected;
  expected.bring_up();
  NodeBench bench;
  bench.configure();
  for (std::uint8_t a = 0; a < 3; ++a) {
    const std::uint32_t sub = (a + 1U) << 8U;
    remap(bench, a, 0x201U + a, {0x2011'0020U | sub, 0x2012'0010U | sub});
    remap(bench, static_cast<std::uint8_t>(kNodeAxes + a), 0x181U + a,
          {0x2014'0010U | sub, 0x2013'0020U | sub});
  }
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  for (int i = 0; i < 60; ++i) {
    bench.sync();
    for (std::size_t a = 0; a < 3; ++a) {
      const auto target = static_cast<std::uint32_t>(bench.drive[a].target);
      hal::CanFrame command{static_cast<std::uint16_t>(0x201 + a), 6, {}};
      store_le(command.data.data(), 4, target);
      hal::CanFrame actual{static_cast<std::uint16_t>(0x181 + a), 6, {}};
      store_le(actual.data.data(), 2, 0x0127);
      store_le(&actual.data[2], 4, target);
      bench.give(actual);
      bench.offset_report(a);
      bench.give(command);
    }
    bench.wait(NodeBench::kPeriod_us);
  }
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_EQ(bench.number(0x2600, 5), 0U);
  EXPECT_EQ(bench.offsets(), expected.offsets());
}

TEST(NodeProcessData, APdoShorterThanItsMappingIsNotTakenAndReported) {
  NodeBench bench;
  bench.bring_up();
  bench.give({0x201, 4, {0, 0, 0, 0}});
  bench.cycles(10);
  EXPECT_TRUE(bench.emergency(ErrorCode::rpdo_length, 1));
  bench.cycles(10);
  EXPECT_TRUE(bench.emergency(ErrorCode::none, 1));
  EXPECT_EQ(bench.state(), NodeState::compensating);
}

// --- drives that can not report what they hold

class NodeStartOffset : public ::testing::Test {
 protected:
  NodeStartOffset() {
    bench.configure();
    EXPECT_EQ(bench.set<std::uint8_t>(0x2200, 5, 0), AbortCode::none);
    bench.load(bench_tables());
    for (BenchDrive& d : bench.drive)
      d.held = d.next = 60'000;
  }
  void cycle() {
    bench.sync();
    for (std::size_t a = 0; a < 3; ++a) {
      bench.drive_data(a);
      bench.controller_data(a);
    }
    bench.wait(NodeBench::kPeriod_us);
  }

  NodeBench bench;
};

TEST_F(NodeStartOffset, IsWaitedForThenTheRampStartsThere) {
  bench.nmt(NmtCommand::start);
  for (int i = 0; i < 20; ++i)
    cycle();
  EXPECT_EQ(bench.state(), NodeState::waiting);
  EXPECT_EQ(count(bench.sent, 0x301), 0U);
  for (std::uint8_t a = 1; a <= 3; ++a)
    ASSERT_EQ(bench.set<std::int32_t>(0x2206, a, 60'000), AbortCode::none);
  for (int i = 0; i < 60; ++i)
    cycle();
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_LE(bench.largest_step, 20'000);
  NodeBench reporting;
  reporting.bring_up();
  EXPECT_EQ(bench.offsets(), reporting.offsets());
}

// Later the drive holds what it was sent: the value counts for one start and would be a step now.
TEST_F(NodeStartOffset, CountsForOneStart) {
  for (std::uint8_t a = 1; a <= 3; ++a)
    ASSERT_EQ(bench.set<std::int32_t>(0x2206, a, 60'000), AbortCode::none);
  bench.nmt(NmtCommand::start);
  for (int i = 0; i < 60; ++i)
    cycle();
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_LE(bench.largest_step, 20'000);
  EXPECT_EQ(bench.set<std::int32_t>(0x2206, 1, 0), AbortCode::device_state);
  bench.nmt(NmtCommand::enter_pre_operational);
  bench.nmt(NmtCommand::start);
  for (int i = 0; i < 10; ++i)
    cycle();
  EXPECT_EQ(bench.state(), NodeState::waiting);
}

}  // namespace
}  // namespace volcomp::node
