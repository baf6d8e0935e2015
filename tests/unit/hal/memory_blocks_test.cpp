// Flash in memory: what NOR flash can do, what it cannot, and a power failure at every step.

#include "hal/loopback/memory_blocks.hpp"

#include <vector>

#include "hal/block_device.hpp"
#include "tests/unit/hal/support.hpp"

namespace volcomp::test {
namespace {

using Blocks = hal::MemoryBlocks<64, 2>;
using Bytes = std::vector<std::uint8_t>;
static_assert(hal::IsBlockDevice<Blocks>::value);

Bytes content(Blocks& blocks) {
  Bytes bytes(Blocks::kBytes);
  EXPECT_TRUE(blocks.read(0, bytes));
  return bytes;
}

bool write(Blocks& blocks, std::size_t at, const Bytes& bytes) {
  return blocks.write(at, {bytes.data(), bytes.size()});
}

TEST(MemoryBlocks, StartErased) {
  Blocks blocks;
  EXPECT_EQ(content(blocks), Bytes(Blocks::kBytes, 0xFF));
}

TEST(MemoryBlocks, ReadBackWhatWasWrittenAndNothingElseChanges) {
  Blocks blocks;
  ASSERT_TRUE(write(blocks, 62, {1, 2, 3, 4}));  // across the sector boundary
  Bytes expected(Blocks::kBytes, 0xFF);
  std::copy_n(Bytes{1, 2, 3, 4}.begin(), 4, expected.begin() + 62);
  EXPECT_EQ(content(blocks), expected);
}

TEST(MemoryBlocks, WritingClearsBitsAndNeverSetsThem) {
  Blocks blocks;
  ASSERT_TRUE(write(blocks, 0, {0xF0}));
  EXPECT_TRUE(write(blocks, 0, {0xC0}));
  EXPECT_FALSE(write(blocks, 0, {0xC1}));
  EXPECT_EQ(content(blocks)[0], 0xC0);
  EXPECT_EQ(blocks.misuses(), 1U);
}

TEST(MemoryBlocks, RefusedWriteChangesNoByte) {
  Blocks blocks;
  ASSERT_TRUE(write(blocks, 1, {0x00}));
  EXPECT_FALSE(write(blocks, 0, {0x11, 0x22, 0x33}));
  EXPECT_EQ(content(blocks)[0], 0xFF);
  EXPECT_EQ(content(blocks)[2], 0xFF);
}

TEST(MemoryBlocks, EraseRestoresOneSectorOnly) {
  Blocks blocks;
  ASSERT_TRUE(write(blocks, 0, Bytes(Blocks::kBytes, 0x00)));
  ASSERT_TRUE(blocks.erase(1));
  Bytes expected(Blocks::kBytes, 0x00);
  std::fill(expected.begin() + 64, expected.end(), std::uint8_t{0xFF});
  EXPECT_EQ(content(blocks), expected);
}

TEST(MemoryBlocks, NothingOutsideTheDevice) {
  Blocks blocks;
  Bytes two(2);
  EXPECT_FALSE(blocks.read(Blocks::kBytes - 1, two));
  EXPECT_FALSE(blocks.read(static_cast<std::size_t>(-1), two));
  EXPECT_FALSE(write(blocks, Blocks::kBytes - 1, two));
  EXPECT_FALSE(blocks.erase(2));
  EXPECT_EQ(blocks.misuses(), 4U);
}

TEST(MemoryBlocks, PowerFailureAtEveryByteLeavesExactlyThePartBefore) {
  const Bytes bytes{10, 11, 12, 13, 14, 15, 16};
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    Blocks blocks;
    blocks.fail_after(n);
    EXPECT_FALSE(write(blocks, 5, bytes));
    EXPECT_EQ(blocks.steps(), n);
    blocks.power_on();
    Bytes expected(Blocks::kBytes, 0xFF);
    std::copy_n(bytes.begin(), n, expected.begin() + 5);
    EXPECT_EQ(content(blocks), expected) << "failed at byte " << n;
  }
}

TEST(MemoryBlocks, PowerFailureWhileErasingLeavesHalfASector) {
  Blocks blocks;
  ASSERT_TRUE(write(blocks, 0, Bytes(64, 0x00)));
  blocks.fail_after(1);
  ASSERT_TRUE(blocks.erase(1));
  EXPECT_FALSE(blocks.erase(0));
  blocks.power_on();
  Bytes expected(Blocks::kBytes, 0xFF);
  std::fill_n(expected.begin() + 32, 32, std::uint8_t{0x00});
  EXPECT_EQ(content(blocks), expected);
}

TEST(MemoryBlocks, WithoutPowerNothingWorksUntilItIsBack) {
  Blocks blocks;
  Bytes one(1);
  blocks.fail_after(0);
  EXPECT_FALSE(write(blocks, 0, one));
  EXPECT_FALSE(blocks.powered());
  EXPECT_FALSE(blocks.read(0, one));
  EXPECT_FALSE(blocks.erase(0));
  EXPECT_FALSE(write(blocks, 0, one));
  blocks.power_on();
  EXPECT_TRUE(blocks.read(0, one));
  EXPECT_TRUE(blocks.erase(0));
  EXPECT_TRUE(write(blocks, 0, one));
  EXPECT_EQ(blocks.misuses(), 0U);
}

}  // namespace
}  // namespace volcomp::test
