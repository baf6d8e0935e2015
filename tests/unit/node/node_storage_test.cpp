// Save, power failure, restart: settings and tables come back, and the machine is compensated
// without a download (CiA 301, 1010h and 1011h).

#include "firmware/node/record_storage.hpp"
#include "hal/loopback/memory_blocks.hpp"
#include "tests/unit/node/node_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;
using canopen::ErrorCode;

constexpr std::uint32_t kSave = 0x65766173;  // "save"
constexpr std::uint32_t kLoad = 0x64616F6C;  // "load"

class NodeStorage : public ::testing::Test {
 protected:
  using Blocks = hal::MemoryBlocks<16384, 2>;

  AbortCode save() { return bench.set<std::uint32_t>(0x1010, 1, kSave); }
  // A record whose period of 1006h tells it from others.
  void save_with_period(std::uint32_t period_us) {
    ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, period_us), AbortCode::none);
    ASSERT_EQ(save(), AbortCode::none);
  }
  // One bit of the parameters of one slot falls (flash can not rise without an erase).
  void damage(std::size_t slot) {
    const std::size_t at = slot * Blocks::kSectorBytes + kParametersAt + 8;
    std::array<std::uint8_t, 1> byte{};
    ASSERT_TRUE(blocks->read(at, byte));
    ASSERT_NE(byte[0], 0);
    byte[0] = 0;
    ASSERT_TRUE(blocks->write(at, {byte.data(), byte.size()}));
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

TEST_F(NodeStorage, WithoutADeviceItSaysSo) {
  NodeBench without;
  EXPECT_EQ(without.set<std::uint32_t>(0x1010, 1, kSave), AbortCode::hardware);
  EXPECT_EQ(without.set<std::uint32_t>(0x1011, 1, kLoad), AbortCode::hardware);
}

TEST_F(NodeStorage, APowerFailureWhileSavingKeepsTheRecordBefore) {
  save_with_period(4000);
  ASSERT_EQ(bench.set<std::uint32_t>(0x1006, 0, 5000), AbortCode::none);
  blocks->fail_after(40);
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
