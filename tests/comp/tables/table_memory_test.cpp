// The tables in memory and whose they are: a bit that flips is found by the background scrub,
// tables of another machine never become active.

#include <cstring>

#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

const LoadedRunner::Positions kSomewhere{-123'456'789, -100'000'000, -200'000'000, 0, 0};

class TableMemory : public ::testing::Test {
 protected:
  Random random{70};
  MachineTables tables = xyfz_tables(20e3, 2e-5, random);
  LoadedRunner runner{kXyfzMachine};

  void SetUp() override {
    auto settings = open_settings<5>();
    settings.ramp_ticks = 50;
    ASSERT_TRUE(runner.start(tables, settings).ok());
    for (int n = 0; n < 100; ++n)
      runner.tick(kSomewhere);
  }

  // Flips one bit of a stored angle, wherever the compensator keeps it.
  void flip_one_bit() {
    const float wanted = -tables.axis[0].value[0][3][4];  // X carries the workpiece: folded as −ε
    auto* bytes = reinterpret_cast<unsigned char*>(runner.compensator.get());
    for (std::size_t at = 0; at + sizeof wanted <= sizeof *runner.compensator;
         at += sizeof wanted) {
      if (std::memcmp(bytes + at, &wanted, sizeof wanted) != 0) continue;
      bytes[at] ^= 0x10U;
      return;
    }
    FAIL() << "the value is nowhere in the compensator";
  }
};

TEST_F(TableMemory, ScrubFindsNothingInHealthyTables) {
  EXPECT_TRUE(runner.compensator->scrub().ok());
  EXPECT_EQ(runner.tick(kSomewhere).status[0] & kTableDamaged, 0);
}

TEST_F(TableMemory, ScrubWithoutTablesHasNothingToSay) {
  const LoadedRunner fresh(kXyfzMachine);
  EXPECT_TRUE(fresh.compensator->scrub().ok());
}

TEST_F(TableMemory, OneFlippedBitRampsTheCorrectionDown) {
  const std::int32_t before = runner.out.offset[0];
  ASSERT_NE(before, 0);
  flip_one_bit();
  EXPECT_EQ(runner.compensator->scrub().reason, Reason::crc_mismatch);
  EXPECT_EQ(runner.compensator->diagnostics().last_rejection.reason, Reason::crc_mismatch);
  const std::int32_t first = runner.tick(kSomewhere).offset[0];
  EXPECT_LT(std::abs(first - before), std::abs(before) / 10 + 2) << "it must not jump";
  for (int n = 0; n < 100; ++n)
    runner.tick(kSomewhere);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_EQ(runner.out.offset[a], 0);
    EXPECT_NE(runner.out.status[a] & kTableDamaged, 0);
    EXPECT_EQ(runner.out.status[a] & kValid, 0);
  }
  // New tables end the alarm.
  ASSERT_TRUE(runner.swap(tables).ok());
  for (int n = 0; n < 100; ++n)
    runner.tick(kSomewhere);
  EXPECT_EQ(runner.out.offset[0], before);
  EXPECT_EQ(runner.out.status[0] & kTableDamaged, 0);
}

TEST_F(TableMemory, TablesOfAnotherMachineIdAreRefused) {
  auto settings = open_settings<5>();
  settings.machine_id = 4711;
  ASSERT_TRUE(runner.compensator->configure(settings).ok());
  MachineTables mine = tables;
  mine.provenance.machine_id = 4711;
  EXPECT_EQ(runner.swap(tables).reason, Reason::machine_mismatch);
  EXPECT_TRUE(runner.swap(mine).ok());
}

// Tables of a machine with another geometry would be folded with the wrong chain.
TEST_F(TableMemory, TablesOfAnotherGeometryAreRefused) {
  for (int change = 0; change < 3; ++change) {
    MachineTables other = tables;
    if (change == 0) other.machine.body[2].joint.offset[1] += 1.0;
    if (change == 1) other.machine.body[1].joint.sign = 1;
    if (change == 2) other.machine.correcting = {1, 0, 2};
    EXPECT_EQ(runner.swap(other).reason, Reason::machine_mismatch) << change;
    EXPECT_EQ(runner.tick(kSomewhere).offset[0], runner.out.offset[0]);
  }
}

// More axes than the compensator has room for: no machine, and no table is ever accepted.
TEST_F(TableMemory, MachineThatDoesNotFitIsNone) {
  MachineDescription large = kXyfzMachine;
  for (std::uint8_t axis = 3; axis < 6; ++axis) {
    Body& body = large.body[large.body_count];
    body.lower = large.tool_body;
    body.joint.kind = JointKind::prismatic;
    body.joint.nc_axis = axis;
    large.tool_body = ++large.body_count;
  }
  MachineTables many = tables;
  many.machine = large;
  LoadedRunner runner_of_six(large);
  EXPECT_EQ(runner_of_six.swap(many).reason, Reason::axes_mismatch);
  EXPECT_EQ(runner_of_six.tick(kSomewhere).offset, (std::array<std::int32_t, 5>{}));
}

}  // namespace
}  // namespace volcomp::test
