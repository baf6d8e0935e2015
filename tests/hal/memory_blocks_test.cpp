// Flash in memory: what flash with error correction can do, what it cannot, and everything an
// operation that was cut short may leave.

#include "tests/hal/memory_blocks.hpp"

#include <set>
#include <vector>

#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using Blocks = MemoryBlocks<128, 2, 32>;
using Bytes = std::vector<std::uint8_t>;
using hal::BlockRead;
static_assert(hal::IsBlockDevice<Blocks>::value);

Bytes content(Blocks& blocks) {
  Bytes bytes(Blocks::kBytes);
  EXPECT_EQ(blocks.read(0, bytes), BlockRead::done);
  return bytes;
}

bool program(Blocks& blocks, std::size_t at, const Bytes& bytes) {
  return blocks.program(at, {bytes.data(), bytes.size()});
}

Bytes counting(std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::uint8_t>(i + 1);
  return bytes;
}

Bytes unit_at(Blocks& blocks, std::size_t at) {
  const Bytes all = content(blocks);
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(at);
  return {first, first + 32};
}

TEST(MemoryBlocks, StartErased) {
  Blocks blocks;
  EXPECT_EQ(content(blocks), Bytes(Blocks::kBytes, 0xFF));
}

TEST(MemoryBlocks, ReadBackWhatWasProgrammedAndNothingElseChanges) {
  Blocks blocks;
  ASSERT_TRUE(program(blocks, 96, counting(64)));  // across the sector boundary
  Bytes expected(Blocks::kBytes, 0xFF);
  std::copy_n(counting(64).begin(), 64, expected.begin() + 96);
  EXPECT_EQ(content(blocks), expected);
  Bytes middle(5);
  ASSERT_EQ(blocks.read(101, middle), BlockRead::done);
  EXPECT_EQ(middle, Bytes({6, 7, 8, 9, 10}));
}

TEST(MemoryBlocks, AUnitIsProgrammedOnceAfterAnErase) {
  Blocks blocks;
  ASSERT_TRUE(program(blocks, 32, Bytes(32, 0xFF)));  // even so
  EXPECT_FALSE(program(blocks, 32, Bytes(32, 0xF0)));
  EXPECT_FALSE(program(blocks, 0, Bytes(64, 0xF0))) << "the second of two";
  EXPECT_EQ(blocks.misuses(), 2U);
  EXPECT_EQ(content(blocks), Bytes(Blocks::kBytes, 0xFF));
  ASSERT_TRUE(blocks.erase(0));
  EXPECT_TRUE(program(blocks, 32, Bytes(32, 0xF0)));
}

TEST(MemoryBlocks, OnlyWholeUnits) {
  Blocks blocks;
  EXPECT_FALSE(program(blocks, 0, Bytes(31)));
  EXPECT_FALSE(program(blocks, 0, Bytes(33)));
  EXPECT_FALSE(program(blocks, 16, Bytes(32)));
  EXPECT_EQ(blocks.misuses(), 3U);
  EXPECT_EQ(blocks.operations(), 0U);
}

TEST(MemoryBlocks, EraseRestoresOneSectorOnly) {
  Blocks blocks;
  ASSERT_TRUE(program(blocks, 0, Bytes(Blocks::kBytes, 0x00)));
  ASSERT_TRUE(blocks.erase(1));
  Bytes expected(Blocks::kBytes, 0x00);
  std::fill(expected.begin() + 128, expected.end(), std::uint8_t{0xFF});
  EXPECT_EQ(content(blocks), expected);
}

TEST(MemoryBlocks, NothingOutsideTheDevice) {
  Blocks blocks;
  Bytes two(2);
  EXPECT_EQ(blocks.read(Blocks::kBytes - 1, two), BlockRead::failed);
  EXPECT_EQ(blocks.read(static_cast<std::size_t>(-1), two), BlockRead::failed);
  EXPECT_FALSE(program(blocks, Blocks::kBytes, Bytes(32)));
  EXPECT_FALSE(blocks.erase(2));
  EXPECT_EQ(blocks.misuses(), 4U);
}

TEST(MemoryBlocks, CountsUnitsAndSectors) {
  Blocks blocks;
  ASSERT_TRUE(blocks.erase(0));
  ASSERT_TRUE(program(blocks, 0, Bytes(96)));
  EXPECT_EQ(blocks.operations(), 4U);
}

// What a unit holds when its programming was cut short, and that its neighbours are as they were.
TEST(MemoryBlocks, APowerFailureTearsTheUnitUnderWorkOnly) {
  const Bytes data = counting(96);
  const Bytes wanted(data.begin() + 32, data.begin() + 64);
  for (const Torn torn : kEveryTorn) {
    SCOPED_TRACE(static_cast<int>(torn));
    Blocks blocks;
    blocks.cut_power_at(1, torn);
    EXPECT_FALSE(program(blocks, 0, data));
    EXPECT_FALSE(blocks.powered());
    Bytes one(1);
    EXPECT_EQ(blocks.read(0, one), BlockRead::failed);
    EXPECT_FALSE(blocks.erase(0));
    EXPECT_FALSE(program(blocks, 96, wanted));
    blocks.power_on();
    Bytes before(32);
    Bytes after(32);
    ASSERT_EQ(blocks.read(0, before), BlockRead::done);
    ASSERT_EQ(blocks.read(64, after), BlockRead::done);
    EXPECT_EQ(before, Bytes(data.begin(), data.begin() + 32));
    EXPECT_EQ(after, Bytes(32, 0xFF));
    EXPECT_EQ(program(blocks, 32, wanted), torn == Torn::untouched) << "begun or not";
  }
}

TEST(MemoryBlocks, ATornUnitHoldsWhatItsNameSays) {
  const auto torn_unit = [](Torn torn) {
    Blocks blocks;
    blocks.cut_power_at(0, torn);
    EXPECT_FALSE(program(blocks, 32, Bytes(32, 0x00)));
    blocks.power_on();
    return unit_at(blocks, 32);
  };
  Bytes half(32, 0xFF);
  std::fill_n(half.begin(), 16, std::uint8_t{0x00});
  EXPECT_EQ(torn_unit(Torn::untouched), Bytes(32, 0xFF));
  EXPECT_EQ(torn_unit(Torn::front), half);
  EXPECT_EQ(torn_unit(Torn::back), Bytes(half.rbegin(), half.rend()));
  EXPECT_EQ(torn_unit(Torn::some_bits), Bytes(32, 0xAA));
  EXPECT_EQ(torn_unit(Torn::complete), Bytes(32, 0x00));
  EXPECT_NE(torn_unit(Torn::random), Bytes(32, 0x00));
}

TEST(MemoryBlocks, ATornSectorHoldsWhatItsNameSays) {
  const auto torn_sector = [](Torn torn) {
    Blocks blocks;
    EXPECT_TRUE(program(blocks, 0, Bytes(256, 0xA5)));
    blocks.cut_power_at(0, torn);
    EXPECT_FALSE(blocks.erase(0));
    blocks.power_on();
    EXPECT_EQ(unit_at(blocks, 128), Bytes(32, 0xA5)) << "the other sector";
    Bytes all = content(blocks);
    all.resize(128);
    return all;
  };
  Bytes half(128, 0xA5);
  std::fill_n(half.begin(), 64, std::uint8_t{0xFF});
  EXPECT_EQ(torn_sector(Torn::untouched), Bytes(128, 0xA5));
  EXPECT_EQ(torn_sector(Torn::front), half);
  EXPECT_EQ(torn_sector(Torn::back), Bytes(half.rbegin(), half.rend()));
  EXPECT_EQ(torn_sector(Torn::some_bits), Bytes(128, 0xF5));
  EXPECT_EQ(torn_sector(Torn::cleared), Bytes(128, 0x00));
  EXPECT_EQ(torn_sector(Torn::complete), Bytes(128, 0xFF));
}

TEST(MemoryBlocks, ATornSectorHasToBeErasedBeforeItIsProgrammed) {
  for (const Torn torn : kEveryTorn) {
    if (torn == Torn::complete || torn == Torn::front) continue;
    Blocks blocks;
    ASSERT_TRUE(program(blocks, 0, Bytes(32, 0xA5)));
    blocks.cut_power_at(0, torn);
    EXPECT_FALSE(blocks.erase(0));
    blocks.power_on();
    EXPECT_FALSE(program(blocks, 0, Bytes(32))) << static_cast<int>(torn);
    EXPECT_TRUE(blocks.erase(0));
    EXPECT_TRUE(program(blocks, 0, Bytes(32)));
    EXPECT_EQ(unit_at(blocks, 0), Bytes(32));
  }
}

TEST(MemoryBlocks, AnUncorrectableUnitIsNotReadUntilItIsErased) {
  Blocks blocks;
  blocks.cut_power_at(0, Torn::uncorrectable);
  EXPECT_FALSE(program(blocks, 32, Bytes(32)));
  blocks.power_on();
  Bytes bytes(64);
  EXPECT_EQ(blocks.read(32, {bytes.data(), 1}), BlockRead::uncorrectable);
  EXPECT_EQ(blocks.read(0, {bytes.data(), 64}), BlockRead::uncorrectable);
  EXPECT_EQ(blocks.read(0, {bytes.data(), 32}), BlockRead::done);
  ASSERT_TRUE(blocks.erase(0));
  EXPECT_EQ(blocks.read(0, {bytes.data(), 64}), BlockRead::done);
}

TEST(MemoryBlocks, AnUnstableUnitReadsAsErasedAsDoneInBetweenAndNotAtAll) {
  Blocks blocks;
  blocks.cut_power_at(0, Torn::unstable);
  EXPECT_FALSE(program(blocks, 0, Bytes(32, 0x3C)));
  blocks.power_on();
  std::set<Bytes> seen;
  int uncorrectable = 0;
  for (int i = 0; i < 100; ++i) {
    Bytes bytes(32);
    const bool done = blocks.read(0, bytes) == BlockRead::done;
    uncorrectable += done ? 0 : 1;
    if (done) seen.insert(bytes);
  }
  EXPECT_GT(uncorrectable, 0);
  EXPECT_EQ(seen.count(Bytes(32, 0xFF)), 1U);
  EXPECT_EQ(seen.count(Bytes(32, 0x3C)), 1U);
  EXPECT_GT(seen.size(), 2U);
}

TEST(MemoryBlocks, AFailureIsReportedOnceAndLeavesTheDeviceWorking) {
  Blocks blocks;
  blocks.fail_at(1, Torn::some_bits);
  EXPECT_FALSE(program(blocks, 0, Bytes(64)));
  EXPECT_TRUE(blocks.powered());
  EXPECT_EQ(unit_at(blocks, 32), Bytes(32, 0xAA));
  EXPECT_TRUE(blocks.erase(0));
  EXPECT_TRUE(program(blocks, 0, Bytes(64)));
}

TEST(MemoryBlocks, ABrokenDeviceStaysBrokenUntilItIsMended) {
  Blocks blocks;
  Bytes bytes(32);
  blocks.refuse_programs(true);
  blocks.refuse_erases(true);
  blocks.refuse_reads(1, true);
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(program(blocks, 0, bytes));
    EXPECT_FALSE(blocks.erase(0));
    EXPECT_EQ(blocks.read(128, bytes), BlockRead::failed);
    EXPECT_EQ(blocks.read(0, bytes), BlockRead::done);
  }
  blocks.refuse_programs(false);
  blocks.refuse_erases(false);
  blocks.refuse_reads(1, false);
  EXPECT_TRUE(program(blocks, 128, bytes));
  EXPECT_TRUE(blocks.erase(1));
  EXPECT_EQ(blocks.read(128, bytes), BlockRead::done);
  EXPECT_EQ(blocks.misuses(), 0U);
}

TEST(MemoryBlocks, StuckBitsStayOneAndFlippedOnesChange) {
  Blocks blocks;
  blocks.set_stuck_bits(0x10);
  ASSERT_TRUE(program(blocks, 0, Bytes(32, 0x00)));
  EXPECT_EQ(unit_at(blocks, 0), Bytes(32, 0x10));
  blocks.flip(3, 0x11);
  EXPECT_EQ(unit_at(blocks, 0)[3], 0x01);
}

}  // namespace
}  // namespace volcomp::test
