// The flash model of the emulated boards, here over ordinary memory: a reset is a new object over
// the same bytes.

#include "hal/mps2/flash_blocks.hpp"

#include <vector>

#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using hal::BlockRead;
using hal::mps2::FlashBlocks;
static_assert(hal::IsBlockDevice<FlashBlocks>::value);

class FlashBlocksTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(blocks_.attach(memory_)); }

  void reset() {
    blocks_ = {};
    ASSERT_TRUE(blocks_.attach(memory_));
  }
  bool program(std::size_t at, const Bytes& bytes) {
    return blocks_.program(at, {bytes.data(), bytes.size()});
  }
  Bytes content() {
    Bytes bytes(FlashBlocks::kBytes);
    EXPECT_EQ(blocks_.read(0, bytes), BlockRead::done);
    return bytes;
  }

  Bytes memory_ = Bytes(FlashBlocks::kMemoryBytes);
  FlashBlocks blocks_;
};

TEST_F(FlashBlocksTest, MemoryNeverUsedBeforeBecomesErased) {
  EXPECT_EQ(content(), Bytes(FlashBlocks::kBytes, 0xFF));
  Random random;
  SCOPED_TRACE(random.trace());
  for (std::uint8_t& byte : memory_)
    byte = static_cast<std::uint8_t>(random.integer(0, 255));
  reset();
  EXPECT_EQ(content(), Bytes(FlashBlocks::kBytes, 0xFF));
}

TEST_F(FlashBlocksTest, WhatWasProgrammedIsThereAfterAReset) {
  const std::size_t at = FlashBlocks::kSectorBytes - 32;
  ASSERT_TRUE(program(at, Bytes(64, 0x5A)));
  reset();
  Bytes expected(FlashBlocks::kBytes, 0xFF);
  std::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(at), 64, std::uint8_t{0x5A});
  EXPECT_EQ(content(), expected);
}

TEST_F(FlashBlocksTest, AUnitIsProgrammedOnceAfterAnErase) {
  ASSERT_TRUE(program(64, Bytes(32, 0xF0)));
  reset();
  EXPECT_FALSE(program(0, Bytes(96, 0x00))) << "only its last unit is at fault";
  EXPECT_EQ(content()[0], 0xFF);
  ASSERT_TRUE(blocks_.erase(0));
  EXPECT_TRUE(program(0, Bytes(96, 0x00)));
}

TEST_F(FlashBlocksTest, EraseRestoresOneSectorOnly) {
  ASSERT_TRUE(program(0, Bytes(FlashBlocks::kBytes, 0x00)));
  ASSERT_TRUE(blocks_.erase(1));
  Bytes expected(FlashBlocks::kBytes, 0x00);
  std::fill_n(expected.begin() + FlashBlocks::kSectorBytes, FlashBlocks::kSectorBytes,
              std::uint8_t{0xFF});
  EXPECT_EQ(content(), expected);
}

TEST_F(FlashBlocksTest, OnlyWholeUnitsAndNothingOutsideTheDevice) {
  Bytes two(2);
  EXPECT_FALSE(program(0, Bytes(31)));
  EXPECT_FALSE(program(16, Bytes(32)));
  EXPECT_FALSE(program(FlashBlocks::kBytes, Bytes(32)));
  EXPECT_FALSE(blocks_.erase(FlashBlocks::kSectors));
  EXPECT_EQ(blocks_.read(FlashBlocks::kBytes - 1, two), BlockRead::failed);
  EXPECT_EQ(blocks_.read(static_cast<std::size_t>(-1), two), BlockRead::failed);
  reset();
  EXPECT_EQ(content(), Bytes(FlashBlocks::kBytes, 0xFF)) << "nor what lies behind it";
}

TEST_F(FlashBlocksTest, TooLittleMemoryIsRefused) {
  FlashBlocks blocks;
  Bytes one(1);
  const Bytes unit(32);
  EXPECT_FALSE(blocks.attach({memory_.data(), memory_.size() - 1}));
  EXPECT_EQ(blocks.read(0, one), BlockRead::failed);
  EXPECT_FALSE(blocks.program(0, {unit.data(), unit.size()}));
  EXPECT_FALSE(blocks.erase(0));
}

}  // namespace
}  // namespace volcomp::test
