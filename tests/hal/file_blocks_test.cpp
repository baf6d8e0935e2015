// Flash in a file: survives the process, refuses foreign files, and keeps the rules of flash.

#include "hal/linux/file_blocks.hpp"

#include <filesystem>
#include <fstream>
#include <vector>

#include "hal/block_device.hpp"
#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using hal::BlockRead;
using hal::FileBlocks;
using hal::OpenResult;
static_assert(hal::IsBlockDevice<FileBlocks>::value);

// A path of its own for every test, gone afterwards.
class FileBlocksTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }
  void TearDown() override { std::filesystem::remove(path_); }

  OpenResult open(FileBlocks& blocks) { return blocks.open(path_.c_str()).result; }

  Bytes content() {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

  void put_file(const std::string& text) { std::ofstream(path_, std::ios::binary) << text; }

  const std::filesystem::path path_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("volcomp_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
       ".flash");
};

bool program(FileBlocks& blocks, std::size_t at, const Bytes& bytes) {
  return blocks.program(at, {bytes.data(), bytes.size()});
}

TEST_F(FileBlocksTest, MissingFileBecomesAnErasedOne) {
  FileBlocks blocks;
  ASSERT_EQ(open(blocks), OpenResult::ok);
  EXPECT_EQ(content(), Bytes(std::size_t{2} * 65536, 0xFF));
}

TEST_F(FileBlocksTest, EmptyFileBecomesAnErasedOne) {
  put_file("");
  FileBlocks blocks;
  ASSERT_EQ(open(blocks), OpenResult::ok);
  EXPECT_EQ(content(), Bytes(FileBlocks::kBytes, 0xFF));
}

TEST_F(FileBlocksTest, WhatWasWrittenIsThereAfterReopening) {
  Random random;
  SCOPED_TRACE(random.trace());
  Bytes written(5024);
  for (std::uint8_t& byte : written)
    byte = static_cast<std::uint8_t>(random.integer(0, 255));
  const std::size_t at = FileBlocks::kSectorBytes - 2496;
  {
    FileBlocks blocks;
    ASSERT_EQ(open(blocks), OpenResult::ok);
    ASSERT_TRUE(program(blocks, at, written));
  }
  FileBlocks blocks;
  ASSERT_EQ(open(blocks), OpenResult::ok);
  Bytes read(written.size());
  ASSERT_EQ(blocks.read(at, read), BlockRead::done);
  EXPECT_EQ(read, written);
}

TEST_F(FileBlocksTest, ProgrammingChangesOnlyTheUnitsGiven) {
  FileBlocks blocks;
  ASSERT_EQ(open(blocks), OpenResult::ok);
  ASSERT_TRUE(program(blocks, 64, Bytes(32, 0x5A)));
  Bytes expected(FileBlocks::kBytes, 0xFF);
  std::fill_n(expected.begin() + 64, 32, std::uint8_t{0x5A});
  EXPECT_EQ(content(), expected);
  Bytes across(3);
  ASSERT_EQ(blocks.read(94, across), BlockRead::done);
  EXPECT_EQ(across, Bytes({0x5A, 0x5A, 0xFF}));
}

TEST_F(FileBlocksTest, EraseRestoresOneSectorOnly) {
  FileBlocks blocks;
  ASSERT_EQ(open(blocks), OpenResult::ok);
  ASSERT_TRUE(program(blocks, 0, Bytes(FileBlocks::kBytes, 0x00)));
  ASSERT_TRUE(blocks.erase(0));
  Bytes expected(FileBlocks::kBytes, 0x00);
  std::fill_n(expected.begin(), FileBlocks::kSectorBytes, std::uint8_t{0xFF});
  EXPECT_EQ(content(), expected);
}

TEST_F(FileBlocksTest, AUnitIsProgrammedOnceAfterAnErase) {
  FileBlocks blocks;
  ASSERT_EQ(open(blocks), OpenResult::ok);
  ASSERT_TRUE(program(blocks, 3200, Bytes(32, 0xF0)));
  const Bytes before = content();
  EXPECT_FALSE(program(blocks, 0, Bytes(3232, 0x00)));  // only its last unit is at fault
  EXPECT_EQ(content(), before);
  ASSERT_TRUE(blocks.erase(0));
  EXPECT_TRUE(program(blocks, 0, Bytes(3232, 0x00)));
}

TEST_F(FileBlocksTest, OnlyWholeUnits) {
  FileBlocks blocks;
  ASSERT_EQ(open(blocks), OpenResult::ok);
  EXPECT_FALSE(program(blocks, 0, Bytes(31)));
  EXPECT_FALSE(program(blocks, 16, Bytes(32)));
  EXPECT_EQ(content(), Bytes(FileBlocks::kBytes, 0xFF));
}

TEST_F(FileBlocksTest, FileOfAnotherSizeIsRefusedAndLeftAlone) {
  put_file("a letter to somebody");
  FileBlocks blocks;
  EXPECT_EQ(open(blocks), OpenResult::wrong_size);
  EXPECT_EQ(content().size(), std::string("a letter to somebody").size());
  Bytes one(1);
  EXPECT_EQ(blocks.read(0, one), BlockRead::failed);
}

TEST_F(FileBlocksTest, SecondUserIsRefusedUntilTheFirstIsGone) {
  FileBlocks second;
  {
    FileBlocks first;
    ASSERT_EQ(open(first), OpenResult::ok);
    EXPECT_EQ(open(second), OpenResult::in_use);
  }
  EXPECT_EQ(open(second), OpenResult::ok);
}

TEST_F(FileBlocksTest, FolderThatDoesNotExistIsReportedWithTheSystemsReason) {
  FileBlocks blocks;
  const hal::OpenStatus status = blocks.open((path_ / "no" / "such").c_str());
  EXPECT_EQ(status.result, OpenResult::failed);
  EXPECT_EQ(status.error_number, ENOENT);
}

TEST_F(FileBlocksTest, NothingOutsideTheDevice) {
  FileBlocks blocks;
  ASSERT_EQ(open(blocks), OpenResult::ok);
  Bytes two(2);
  EXPECT_EQ(blocks.read(FileBlocks::kBytes - 1, two), BlockRead::failed);
  EXPECT_EQ(blocks.read(static_cast<std::size_t>(-1), two), BlockRead::failed);
  EXPECT_FALSE(program(blocks, FileBlocks::kBytes, Bytes(32)));
  EXPECT_FALSE(blocks.erase(FileBlocks::kSectors));
  EXPECT_EQ(content().size(), FileBlocks::kBytes);
}

TEST_F(FileBlocksTest, NothingWorksWhileClosed) {
  FileBlocks blocks;
  Bytes one(1);
  EXPECT_EQ(blocks.read(0, one), BlockRead::failed);
  EXPECT_FALSE(program(blocks, 0, Bytes(32)));
  EXPECT_FALSE(blocks.erase(0));
}

}  // namespace
}  // namespace volcomp::test
