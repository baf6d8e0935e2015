// Save, power failure, restart: settings and tables come back, and the machine is compensated
// without a download (CiA 301, 1010h and 1011h).

#include "firmware/node/store/read_only_storage.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "tests/firmware/node/node_bench.hpp"
#include "tests/hal/memory_blocks.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;

// X is wrong by this much everywhere, Y and Z are right.
MachineTables tables_of(std::int32_t error_nm) {
  MachineTables tables;
  tables.machine = kXyfzMachine;
  for (std::size_t a = 0; a < NodeBench::kDrives; ++a) {
    tables.axis[a].q0 = -100'000'000;
    tables.axis[a].pitch = 100'000'000;
    tables.axis[a].knots = 2;
  }
  for (auto& travel : tables.axis[0].value)
    travel[0][0] = travel[1][0] = static_cast<float>(error_nm);
  return tables;
}

class NodeStorage : public ::testing::Test {
 protected:
  using Blocks = test::MemoryBlocks<16384, 2>;

  AbortCode save() { return bench.set<std::uint32_t>(0x1010, 1, kSave); }
  // A record marked by its period of 1006h.
  void save_with_period(std::uint32_t period_us) {
    ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, period_us), AbortCode::none);
    ASSERT_EQ(save(), AbortCode::none);
  }
  void damage(std::size_t slot) {
    blocks->flip(slot * Blocks::kSectorBytes + kParametersAt + 8, 1);
  }

  std::unique_ptr<Blocks> blocks = std::make_unique<Blocks>();
  RecordStorage<Blocks> storage{*blocks};
  NodeBench bench{&storage};
};

TEST_F(NodeStorage, NothingStoredIsNoError) {
  EXPECT_EQ(bench.number(0x2600, 11), 0U);
  bench.wait(50'000);
  EXPECT_TRUE(bench.emergencies.empty());
}

TEST_F(NodeStorage, RestartBringsParametersAndTablesAndCompensatesWithoutADownload) {
  bench.bring_up();
  const auto before = bench.offsets();
  const std::uint64_t crc = bench.number(0x2112, 7);
  bench.nmt(canopen::NmtCommand::enter_pre_operational);
  ASSERT_EQ(save(), AbortCode::none);

  bench.power_on();
  EXPECT_EQ(bench.number(0x2600, 11), 1U);
  EXPECT_EQ(bench.number(0x1006, 0), NodeBench::kPeriod_us);
  EXPECT_EQ(bench.number(0x2010, 3), 3U);
  EXPECT_EQ(bench.number(0x2112, 7), crc);
  bench.nmt(canopen::NmtCommand::start);
  bench.cycles(60);
  EXPECT_EQ(bench.state(), NodeState::compensating);
  EXPECT_EQ(bench.offsets(), before);
  EXPECT_LE(bench.largest_step, 20'000);
}

TEST_F(NodeStorage, ResetCommunicationBringsTheStoredCommunicationBack) {
  save_with_period(4000);
  ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, 1000), AbortCode::none);
  bench.nmt(canopen::NmtCommand::reset_communication);
  EXPECT_EQ(bench.number(0x1006, 0), 4000U);
}

TEST_F(NodeStorage, NeedsTheSignature) {
  EXPECT_EQ(bench.set<std::uint32_t>(0x1010, 1, kLoad), AbortCode::cannot_store);
  EXPECT_EQ(bench.set<std::uint32_t>(0x1011, 1, kSave), AbortCode::cannot_store);
  EXPECT_EQ(bench.number(0x1010, 1), 1U);  // saves on command
  EXPECT_EQ(bench.number(0x1011, 1), 1U);
}

TEST_F(NodeStorage, NotWhileTheAxesMove) {
  bench.bring_up();
  EXPECT_EQ(save(), AbortCode::device_state);
  EXPECT_EQ(bench.set<std::uint32_t>(0x1011, 1, kLoad), AbortCode::device_state);
}

// The active tables can only be saved while their image is still there.
TEST_F(NodeStorage, NotWhenTheImageOfTheActiveTablesIsGone) {
  bench.configure();
  bench.load(bench_tables());
  ASSERT_EQ(bench.write({0x2110, 1}, image_of(bench_tables(1))), AbortCode::none);
  EXPECT_EQ(save(), AbortCode::local_control);
  ASSERT_EQ(bench.command(TableCommand::activate), AbortCode::none);
  EXPECT_EQ(save(), AbortCode::none);
}

// CiA 301, 7.5.2.13: bit 0 of what is read shows whether the device saves on command.
TEST_F(NodeStorage, WithoutADeviceItSaysSo) {
  NodeBench without;
  EXPECT_EQ(without.number(0x1010, 1), 0U);
  EXPECT_EQ(without.number(0x1011, 1), 0U);
  EXPECT_EQ(without.set<std::uint32_t>(0x1010, 1, kSave), AbortCode::hardware);
  EXPECT_EQ(without.set<std::uint32_t>(0x1011, 1, kLoad), AbortCode::hardware);
  EXPECT_EQ(without.set<std::uint8_t>(0x2000, 3, 1), AbortCode::none);
  EXPECT_EQ(without.number(0x1010, 1), 0U);
  EXPECT_EQ(without.number(0x1011, 1), 0U);
}

TEST_F(NodeStorage, AMemoryThatCanOnlyBeReadIsUsedAndNotWritten) {
  save_with_period(4000);
  ReadOnlyStorage kept(storage);
  NodeBench reader(&kept);
  EXPECT_EQ(reader.number(0x1006, 0), 4000U);
  EXPECT_EQ(reader.number(0x2600, 11), 1U);
  EXPECT_EQ(reader.number(0x1010, 1), 0U);
  EXPECT_EQ(reader.number(0x1011, 1), 0U);
  EXPECT_EQ(reader.set<std::uint32_t>(0x1010, 1, kSave), AbortCode::hardware);
  EXPECT_EQ(reader.number(0x2600, 12), 11U);
  EXPECT_EQ(reader.set<std::uint32_t>(0x1011, 1, kLoad), AbortCode::hardware);
  reader.wait(50'000);
  EXPECT_TRUE(reader.emergency(ErrorCode::store_failed, 11));
  reader.power_on();
  EXPECT_EQ(reader.number(0x1006, 0), 4000U);
}

// CiA 301, 7.5.2.13: a failed save answers 0606 0000h. The node reports which step it was.
TEST_F(NodeStorage, AFailureOfTheMemoryIsReportedUntilASaveSucceeds) {
  save_with_period(4000);
  const auto expect_reported = [this](StoreResult why) {
    const auto number = static_cast<std::uint8_t>(why);
    ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, 5000), AbortCode::none);
    EXPECT_EQ(save(), AbortCode::hardware);
    EXPECT_EQ(bench.number(0x2600, 12), number);
    bench.wait(50'000);
    EXPECT_TRUE(bench.emergency(ErrorCode::store_failed, number)) << sentence(why);
    EXPECT_EQ(bench.number(0x1001, 0), 1U);
  };
  blocks->refuse_erases(true);
  expect_reported(StoreResult::erase_failed);
  blocks->refuse_erases(false);
  blocks->refuse_programs(true);
  expect_reported(StoreResult::write_failed);
  blocks->refuse_programs(false);
  blocks->set_stuck_bits(0x01);
  expect_reported(StoreResult::verify_failed);
  blocks->set_stuck_bits(0);
  blocks->refuse_reads(1, true);  // the slot that is written
  expect_reported(StoreResult::read_failed);
  blocks->refuse_reads(1, false);

  bench.power_on();
  EXPECT_EQ(bench.number(0x1006, 0), 4000U) << "the last good record stays";
  EXPECT_EQ(bench.number(0x2600, 11), 2U);
  EXPECT_EQ(bench.number(0x2600, 12), 0U) << "not asked since the start";
  bench.emergencies.clear();
  save_with_period(5000);
  bench.wait(100'000);
  EXPECT_EQ(bench.number(0x2600, 12), 4U);
  EXPECT_EQ(bench.number(0x1001, 0), 0U);
  EXPECT_TRUE(bench.emergency(ErrorCode::none, 2)) << "the lost parameters are no longer missed";
}

TEST_F(NodeStorage, AFailedRestoreIsReportedAndForgetsNothing) {
  save_with_period(4000);
  blocks->refuse_erases(true);
  EXPECT_EQ(bench.set<std::uint32_t>(0x1011, 1, kLoad), AbortCode::hardware);
  EXPECT_EQ(bench.number(0x2600, 12), static_cast<std::uint8_t>(StoreResult::erase_failed));
  blocks->refuse_erases(false);
  bench.power_on();
  EXPECT_EQ(bench.number(0x1006, 0), 4000U);
}

TEST_F(NodeStorage, AMemoryThatDoesNotAnswerAtTheStartIsReported) {
  save_with_period(4000);
  blocks->refuse_reads(0, true);
  blocks->refuse_reads(1, true);
  bench.power_on();
  bench.wait(50'000);
  EXPECT_EQ(bench.number(0x1006, 0), 0U);
  EXPECT_EQ(bench.number(0x2600, 11), static_cast<std::uint8_t>(StoreResult::read_failed));
  EXPECT_TRUE(bench.emergency(ErrorCode::parameters_lost, 7));
}

// The machine starts with the offsets the drives hold, and goes from there along s(u) = 6u⁵ − 15u⁴
// + 10u³ to those of the tables.
TEST_F(NodeStorage, StoredTablesAreRampedIn) {
  constexpr int kRampCycles = 20;
  constexpr std::int32_t kError_nm = 3000;
  bench.configure();  // with this ramp
  bench.load(tables_of(kError_nm));
  ASSERT_EQ(save(), AbortCode::none);

  bench.power_on();
  constexpr std::int32_t kHeld_nm = 700;
  bench.drive[0].held = bench.drive[0].next = kHeld_nm;
  bench.nmt(canopen::NmtCommand::start);
  while (bench.state() != NodeState::compensating)
    bench.cycle();
  for (int k = 1; k <= kRampCycles; ++k, bench.cycle()) {
    const double u = static_cast<double>(k) / kRampCycles;
    const double s = u * u * u * (10 - 15 * u + 6 * u * u);
    EXPECT_NEAR(bench.drive[0].next, kHeld_nm + s * (kError_nm - kHeld_nm), 1.0) << "cycle " << k;
    EXPECT_EQ(bench.drive[1].next, 0);
  }
  EXPECT_EQ(bench.drive[0].next, kError_nm);
}

TEST_F(NodeStorage, WithoutTablesNothingIsCorrectedAndTheStateSaysSo) {
  bench.configure();
  ASSERT_EQ(save(), AbortCode::none);
  bench.power_on();
  bench.drive[0].held = bench.drive[0].next = 700;
  bench.nmt(canopen::NmtCommand::start);
  bench.cycles(60);
  EXPECT_EQ(bench.number(0x2600, 1), static_cast<std::uint8_t>(NodeState::no_tables));
  EXPECT_EQ(bench.number(0x2112, 7), 0U);
  EXPECT_EQ(bench.offsets(), (std::array<std::int32_t, 3>{700, 0, 0}));
}

TEST_F(NodeStorage, APowerFailureWhileSavingKeepsTheRecordBefore) {
  save_with_period(4000);
  ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, 5000), AbortCode::none);
  blocks->cut_power_at(4, test::Torn::random);
  EXPECT_EQ(save(), AbortCode::hardware);
  blocks->power_on();
  bench.power_on();
  EXPECT_EQ(bench.number(0x1006, 0), 4000U);
}

TEST_F(NodeStorage, DamagedNewestRecordGivesTheOlderAndAnEmergency) {
  save_with_period(4000);
  save_with_period(5000);
  bench.power_on();
  ASSERT_EQ(bench.number(0x1006, 0), 5000U);
  damage(1);
  bench.power_on();
  bench.wait(50'000);
  EXPECT_EQ(bench.number(0x1006, 0), 4000U);
  EXPECT_EQ(bench.number(0x2600, 11), 2U);
  EXPECT_TRUE(bench.emergency(ErrorCode::parameters_lost, 2));
  EXPECT_EQ(bench.number(0x1001, 0), 1U);
}

TEST_F(NodeStorage, NothingUsableGivesTheDefaultsAndAnEmergency) {
  save_with_period(4000);
  damage(0);
  bench.power_on();
  bench.wait(50'000);
  EXPECT_EQ(bench.number(0x1006, 0), 0U);
  EXPECT_EQ(bench.number(0x2600, 11), 3U);
  EXPECT_TRUE(bench.emergency(ErrorCode::parameters_lost, 3));
}

// CiA 301, 7.5.2.14: the defaults become valid with the next reset.
TEST_F(NodeStorage, RestoreTakesEffectWithTheNextReset) {
  bench.configure();
  bench.load(bench_tables());
  save_with_period(4000);
  ASSERT_EQ(bench.set<std::uint32_t>(0x1011, 1, kLoad), AbortCode::none);
  EXPECT_EQ(bench.number(0x1006, 0), 4000U);
  bench.nmt(canopen::NmtCommand::reset_node);
  EXPECT_EQ(bench.number(0x1006, 0), 0U);
  EXPECT_EQ(bench.number(0x2010, 1), 0U);
  EXPECT_EQ(bench.number(0x2112, 7), 0U);
  EXPECT_EQ(bench.number(0x2600, 11), 0U);
}

}  // namespace
}  // namespace volcomp::node
