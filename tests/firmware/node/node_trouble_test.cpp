// A node whose memory, drives or bus do not do what they should, and machines too large for it.

#include "tests/firmware/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;
using canopen::NmtCommand;

// More axes than the node has room for.
TEST(NodeMachine, OfTooManyAxesIsRefused) {
  MachineTables wide = bench_tables();
  for (std::uint8_t axis = 3; axis <= kNodeAxes; ++axis) {
    wide.axis[axis] = wide.axis[0];
    Body& body = wide.machine.body[wide.machine.body_count];
    body.lower = wide.machine.tool_body;
    body.joint = {JointKind::prismatic, Axis::z, 1, Branch::tool, axis, 'W'};
    wide.machine.tool_body = ++wide.machine.body_count;
  }
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(wide)), AbortCode::none);
  EXPECT_EQ(bench.command(TableCommand::activate), AbortCode::general);
  EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::too_many_axes);
  EXPECT_EQ(bench.number(0x2112, 1), static_cast<std::uint64_t>(TableState::refused));
  bench.load(bench_tables());
  bench.nmt(NmtCommand::start);
  bench.cycles(60);
  EXPECT_EQ(bench.state(), NodeState::compensating);
}

// A bit of the tables in use changes in memory: found within 1 s, and from then on no offset.
TEST(NodeMemory, ABitThatChangesInTheTablesIsFound) {
  for (const bool moving : {true, false}) {
    NodeBench bench;
    bench.configure();
    ASSERT_EQ(bench.write({0x2110, 1}, image_of(bench_tables())), AbortCode::none);
    ASSERT_EQ(bench.command(TableCommand::validate), AbortCode::none);
    // What arming writes is mostly tables: the middle of it is one.
    auto* const memory = reinterpret_cast<std::uint8_t*>(bench.node.get());
    const Bytes before(memory, memory + sizeof(Node));
    ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
    std::vector<std::size_t> written;
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (memory[i] != before[i]) written.push_back(i);
    }
    ASSERT_GT(written.size(), 1000U);
    if (moving) {
      bench.nmt(NmtCommand::start);
      bench.cycles(60);
      ASSERT_EQ(bench.state(), NodeState::compensating);
    }
    ASSERT_NE(bench.number(0x2112, 7), 0U);
    memory[written[written.size() / 2]] ^= 0x10U;
    bench.wait(1'000'000);
    EXPECT_TRUE(bench.emergency(ErrorCode::table_damaged, 0)) << moving;
    EXPECT_EQ(bench.number(0x2112, 7), 0U) << moving;
    EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::crc_mismatch);
    if (moving) {
      bench.cycles(60);
      EXPECT_EQ(bench.offsets(), (std::array<std::int32_t, 3>{}));
    }
  }
}

// CiA 301, table 26: 8120h error passive mode, 8140h recovered from bus-off.
TEST(NodeBus, ErrorPassiveAndTheWayBackFromBusOffAreTold) {
  using hal::CanBusState;
  NodeBench bench;
  bench.bring_up();
  const auto told = [&bench](CanBusState state) {
    bench.emergencies.clear();
    for (int turn = 0; turn < 5; ++turn) {  // every turn anew
      bench.node->bus_state(state);
      bench.wait(20'000);
    }
    std::vector<std::uint16_t> codes;
    for (const BenchEmergency& emergency : bench.emergencies)
      if (emergency.code != static_cast<std::uint16_t>(ErrorCode::rpdo_timeout))
        codes.push_back(emergency.code);
    return codes;
  };
  using Codes = std::vector<std::uint16_t>;
  EXPECT_EQ(told(CanBusState::active), Codes{});
  EXPECT_EQ(told(CanBusState::warning), Codes{});
  EXPECT_EQ(told(CanBusState::passive), Codes{0x8120});
  EXPECT_NE(bench.number(0x1001, 0) & canopen::kCommunicationError, 0U);
  EXPECT_EQ(told(CanBusState::off), Codes{});
  EXPECT_EQ(told(CanBusState::passive), Codes{0x8140}) << "8120h was never over";
  EXPECT_EQ(told(CanBusState::warning), Codes{0}) << "8120h is";
  EXPECT_EQ(told(CanBusState::active), Codes{0}) << "8140h is";
  EXPECT_EQ(told(CanBusState::off), Codes{});
  EXPECT_EQ(told(CanBusState::active), (Codes{0x8140, 0}));
}

// Damage outside the tables is reported by a code of its own, and new tables do not mend it.
TEST(NodeMemory, ABitThatChangesInTheChainIsFound) {
  NodeBench bench;
  bench.bring_up();
  const RuntimeChain& chain = bench.node->compensator().machine().chain;
  auto* const bytes = reinterpret_cast<unsigned char*>(const_cast<RuntimeChain*>(&chain));
  const std::size_t at = offsetof(RuntimeChain, inverse) + offsetof(InversePlan, gain);
  bytes[at] ^= 0x04U;
  bench.cycles(500);
  EXPECT_TRUE(bench.emergency(ErrorCode::memory_damaged, 0));
  EXPECT_EQ(bench.offsets(), (std::array<std::int32_t, 3>{}));
  bench.emergencies.clear();
  ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  bench.cycles(500);
  EXPECT_TRUE(bench.emergency(ErrorCode::memory_damaged, 0));
  EXPECT_EQ(bench.offsets(), (std::array<std::int32_t, 3>{}));
  bytes[at] ^= 0x04U;
}

TEST(NodeMemory, ABitThatChangesInTheProgramStopsTheCorrections) {
  std::vector<std::uint8_t> program(50'000, 0x5A);
  NodeBench bench;
  bench.node->watch_program({program.data(), program.size()});
  bench.bring_up();
  bench.cycles(500);
  EXPECT_TRUE(bench.emergencies.empty());
  EXPECT_NE(bench.offsets(), (std::array<std::int32_t, 3>{}));
  program[12'345] ^= 0x20U;
  bench.cycles(500);
  EXPECT_TRUE(bench.emergency(ErrorCode::program_damaged, 0));
  EXPECT_EQ(bench.offsets(), (std::array<std::int32_t, 3>{}));
}

// A drive that reports to hold 2 m: nothing is sent to any.
TEST(NodeDrives, OffsetsThatNoDriveCanHoldAreNotContinued) {
  NodeBench bench;
  bench.configure();
  ASSERT_EQ(bench.set<std::uint32_t>(0x2030, 1, 1000), AbortCode::none);  // µm
  bench.load(bench_tables());
  bench.drive[0].held = bench.drive[0].next = 2'000'000;
  bench.nmt(NmtCommand::start);
  bench.cycles(60);
  EXPECT_NE(bench.state(), NodeState::compensating);
  EXPECT_EQ(static_cast<Reason>(bench.number(0x2112, 2)), Reason::bad_setting);
  EXPECT_EQ(bench.offsets(), (std::array<std::int32_t, 3>{2'000'000, 0, 0}));
}

// 2000h:03: actual positions need no frames of the controller; targets do.
TEST(NodeDrives, ActualPositionsAreEnoughWhereTheyAreAskedFor) {
  for (const bool by_actual : {true, false}) {
    NodeBench bench;
    bench.configure();
    ASSERT_EQ(bench.set<std::uint8_t>(0x2000, 3, by_actual ? 1 : 0), AbortCode::none);
    bench.load(bench_tables());
    bench.nmt(NmtCommand::start);
    for (int i = 0; i < 60; ++i) {
      bench.sync();
      for (std::size_t a = 0; a < NodeBench::kDrives; ++a) {
        bench.drive_data(a);
        bench.offset_report(a);
      }
      bench.wait(NodeBench::kPeriod_us);
    }
    EXPECT_EQ((bench.status(0) & kStale) != 0, !by_actual);
    EXPECT_EQ((bench.status(0) & kDropped) != 0, !by_actual);
  }
}

// Before the node has started, and more frames than a counter holds.
TEST(NodeFrames, LostOnesAreCountedToTheEndOfTheCounter) {
  const auto unborn = std::make_unique<Node>(NodeBench::kId, nullptr);
  unborn->frames_lost(3);
  unborn->background_overdue(true);
  EXPECT_EQ(unborn->objects().frames_lost, 0U);
  EXPECT_EQ(unborn->objects().communication.error_register, 0);
  NodeBench bench;
  bench.node->frames_lost(UINT32_MAX - 2);
  bench.node->frames_lost(5);
  EXPECT_EQ(bench.number(0x2600, 14), UINT32_MAX);
  bench.wait(50'000);
  EXPECT_TRUE(bench.emergency(ErrorCode::can_overrun, 0));
}

}  // namespace
}  // namespace volcomp::node
