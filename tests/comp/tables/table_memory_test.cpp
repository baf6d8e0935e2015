// The tables in memory and their machine: a bit that flips is found by the background scrub, tables
// of another machine never become active.

#include <algorithm>
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

// --- in slices

// All the tick works with, and the sizes of it: one bit of each.
class ScrubInSlices : public TableMemory {
 protected:
  static constexpr std::size_t kSlice = 128;
  // What is behind the place that is just being read waits for the end of the next pass.
  static constexpr std::size_t kMostCalls = 2 * (LoadedCompensator::kScrubBytes / kSlice + 2);

  void SetUp() override {
    for (AxisLimits& axis : settings.axis)
      axis = {{4'123'457, 7'654'321, 654'321, 0}, 12'347, 1'234'567'891'011};
    ASSERT_TRUE(runner.start(tables, settings).ok());
    for (int n = 0; n < 300; ++n)
      runner.tick(kSomewhere);
    ASSERT_NE(runner.out.status[0] & kValid, 0);
  }

  unsigned char* memory() { return reinterpret_cast<unsigned char*>(runner.compensator.get()); }
  // Where the compensator has these bytes.
  template <class Value>
  std::vector<std::size_t> places(const Value& value) {
    std::vector<std::size_t> found;
    for (std::size_t at = 0; at + sizeof value <= sizeof *runner.compensator; at += 4) {
      if (std::memcmp(memory() + at, &value, sizeof value) == 0) found.push_back(at);
    }
    return found;
  }
  // After how many calls the scrub sees this bit, beginning anywhere; then all is as before.
  std::size_t calls_to_find(std::size_t at, unsigned bit) {
    for (std::int64_t ahead = random.integer(0, static_cast<std::int64_t>(kMostCalls)); ahead > 0;
         --ahead)
      EXPECT_TRUE(runner.compensator->scrub(kSlice).ok());
    const auto flip = static_cast<unsigned char>(1U << bit);
    memory()[at] ^= flip;
    std::size_t calls = 1;
    while (calls <= kMostCalls && runner.compensator->scrub(kSlice).ok())
      ++calls;
    memory()[at] ^= flip;
    runner.tick(kSomewhere);  // takes the deactivation
    EXPECT_TRUE(runner.swap(tables).ok());
    runner.tick(kSomewhere);
    EXPECT_TRUE(runner.compensator->active());
    return calls;
  }

  CompensatorSettings<5> settings = open_settings<5>();
};

TEST_F(ScrubInSlices, FindsNothingInHealthyMemoryWhateverTheSlice) {
  for (const std::size_t slice : {std::size_t{1}, std::size_t{7}, kSlice, std::size_t{1} << 20U}) {
    for (std::size_t bytes = 0; bytes < 3 * LoadedCompensator::kScrubBytes; bytes += slice)
      ASSERT_TRUE(runner.compensator->scrub(slice).ok());
    runner.tick(kSomewhere);
    EXPECT_NE(runner.out.status[0] & kValid, 0);
  }
}

TEST_F(ScrubInSlices, FindABitOfTheTables) {
  const float angle = -tables.axis[0].value[0][3][4];
  const std::vector<std::size_t> all = places(angle);
  ASSERT_FALSE(all.empty());
  // It may lie in the spare half; the tables staged in between then lie there, and it in use.
  for (unsigned byte = 0; byte < 4; ++byte) {
    const std::size_t calls = calls_to_find(all[0] + byte, 3);
    EXPECT_LE(std::min(calls, calls_to_find(all[0] + byte, 3)), kMostCalls);
  }
}

TEST_F(ScrubInSlices, FindABitOfTheChain) {
  const auto* const chain =
      reinterpret_cast<const unsigned char*>(&runner.compensator->machine().chain);
  const auto at = static_cast<std::size_t>(chain - memory());
  for (std::size_t byte = 0; byte < sizeof(RuntimeChain); byte += 61)
    ASSERT_LE(calls_to_find(at + byte, byte % 8), kMostCalls) << byte;
}

// Once as configured, once as the tick takes it.
TEST_F(ScrubInSlices, FindABitOfSettingsAndOfWhatIsDerivedFromThem) {
  const auto find = [&](const auto& value, std::size_t least) {
    const std::vector<std::size_t> all = places(value);
    EXPECT_GE(all.size(), least);
    for (const std::size_t at : all) {
      for (unsigned bit = 0; bit < 8 * sizeof value; bit += 13)
        ASSERT_LE(calls_to_find(at + bit / 8, bit % 8), kMostCalls) << at << " bit " << bit;
    }
  };
  constexpr std::size_t kAxes = 5;
  find(settings.axis[0].limit, kAxes);
  find(Magnitude(static_cast<float>(settings.axis[0].limit)), kAxes);
  find(settings.axis[0].rate, 2 * kAxes);
  find(settings.axis[0].soft_rate, 2 * kAxes);
  find(settings.axis[0].hysteresis, 2 * kAxes);
  find(settings.axis[0].max_step, kAxes);
}

// Staging writes the hysteresis of the axes anew; it must not confirm a setting that is damaged.
TEST_F(ScrubInSlices, StagingHidesNoDamagedSetting) {
  std::vector<std::size_t> settings_at = places(settings.axis[0].limit);
  for (const std::int32_t value : {settings.axis[0].rate, settings.axis[0].hysteresis})
    for (const std::size_t at : places(value))
      settings_at.push_back(at);
  ASSERT_GE(settings_at.size(), std::size_t{5 + 10 + 10});
  for (const std::size_t at : settings_at) {
    const unsigned char healthy = memory()[at];
    memory()[at] ^= 4U;
    ASSERT_TRUE(runner.swap(tables).ok());
    runner.tick(kSomewhere);
    const bool written_anew = memory()[at] == healthy;
    EXPECT_EQ(runner.compensator->scrub().ok(), written_anew) << at;
    memory()[at] = healthy;
    runner.tick(kSomewhere);  // takes the deactivation
  }
}

// New tables change nothing about a damaged chain.
TEST_F(ScrubInSlices, SaysWhatIsDamaged) {
  const auto* const chain =
      reinterpret_cast<const unsigned char*>(&runner.compensator->machine().chain);
  const auto at = static_cast<std::size_t>(chain - memory());
  memory()[at + 20] ^= 1U;
  const Status status = runner.compensator->scrub();
  EXPECT_EQ(status.reason, Reason::crc_mismatch);
  EXPECT_STREQ(status.where.field, "machine");
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
