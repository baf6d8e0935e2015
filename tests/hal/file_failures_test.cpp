// Flash in a file while the system reports errors: each is passed on, none is taken for success.

#include <fcntl.h>
#include <sys/stat.h>

#include <filesystem>
#include <vector>

#include "hal/linux/file_blocks.hpp"
#include "tests/hal/support.hpp"
#include "tests/hal/system_calls.hpp"

namespace volcomp::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using hal::BlockRead;
using hal::FileBlocks;
using hal::OpenResult;

class FileFailures : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }
  void TearDown() override { std::filesystem::remove(path_); }

  void expect_refused(OpenResult result, int error) {
    const hal::OpenStatus status = blocks.open(path_.c_str());
    EXPECT_EQ(status.result, result);
    EXPECT_EQ(status.error_number, error);
    Bytes one(1);
    EXPECT_EQ(blocks.read(0, one), BlockRead::failed) << "closed";
  }

  const std::filesystem::path path_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("volcomp_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
       ".flash");
  SystemCalls calls;
  FileBlocks blocks;
};

// --- opening

TEST_F(FileFailures, AFullDiskHasNoRoomForANewStore) {
  calls.ftruncate = [](int, off_t) { return failing(EFBIG); };
  expect_refused(OpenResult::failed, EFBIG);
  calls.ftruncate = nullptr;
  std::filesystem::resize_file(path_, 0);
  calls.pwrite = [](int, const void*, std::size_t, off_t at) -> ssize_t {
    return at < off_t{FileBlocks::kSectorBytes} ? 1024 : failing(ENOSPC);
  };
  expect_refused(OpenResult::failed, ENOSPC);
}

TEST_F(FileFailures, AStoreThatDoesNotReachTheMediumIsNotOpened) {
  calls.fdatasync = [](int) { return failing(EIO); };
  expect_refused(OpenResult::failed, EIO);
}

// fsync(2): without it a power failure may leave the file without its name.
TEST_F(FileFailures, TheNameOfANewStoreReachesTheMediumBeforeItsBytes) {
  bool synced = false;
  calls.fsync = [&](int fd) {
    struct stat folder {};
    struct stat parent {};
    EXPECT_EQ(::fstat(fd, &folder), 0);
    EXPECT_EQ(::stat(path_.parent_path().c_str(), &parent), 0);
    EXPECT_EQ(folder.st_ino, parent.st_ino);
    EXPECT_EQ(std::filesystem::file_size(path_), 0U);
    synced = true;
    return 0;
  };
  ASSERT_TRUE(blocks.open(path_.c_str()).ok());
  EXPECT_TRUE(synced);
  blocks.close();
  synced = false;
  ASSERT_TRUE(blocks.open(path_.c_str()).ok());
  EXPECT_FALSE(synced) << "it was there";
}

TEST_F(FileFailures, AStoreWhoseNameDoesNotReachTheMediumIsMadeAgain) {
  calls.fsync = [](int) { return failing(EIO); };
  expect_refused(OpenResult::failed, EIO);
  expect_refused(OpenResult::failed, EIO);
  calls.fsync = [](int) { return failing(EINVAL); };  // a file system without
  EXPECT_TRUE(blocks.open(path_.c_str()).ok());
}

// As root everything may be written; a kernel that refuses is played.
TEST_F(FileFailures, AStoreThatMayOnlyBeReadIsRead) {
  const Bytes unit(FileBlocks::kUnitBytes, 0x5A);
  ASSERT_TRUE(blocks.open(path_.c_str()).ok());
  EXPECT_FALSE(blocks.read_only());
  ASSERT_TRUE(blocks.program(64, {unit.data(), unit.size()}));
  for (const int error : {EROFS, EACCES, EPERM}) {
    calls.open = [error](const char* path, int flags) {
      return (flags & O_ACCMODE) == O_RDONLY ? kernel_open(path, flags) : failing(error);
    };
    ASSERT_TRUE(blocks.open(path_.c_str()).ok()) << error;
    EXPECT_TRUE(blocks.read_only());
    Bytes read(unit.size());
    EXPECT_EQ(blocks.read(64, read), BlockRead::done);
    EXPECT_EQ(read, unit);
    EXPECT_FALSE(blocks.program(128, {unit.data(), unit.size()}));
    EXPECT_FALSE(blocks.erase(0));
  }
  blocks.close();
  EXPECT_FALSE(blocks.read_only());
}

TEST_F(FileFailures, WhereNothingCanBeWrittenAMissingStoreIsNotMade) {
  calls.open = [](const char* path, int flags) {
    return (flags & O_ACCMODE) == O_RDONLY ? kernel_open(path, flags) : failing(EROFS);
  };
  expect_refused(OpenResult::failed, EROFS);
  calls.open = nullptr;
  ASSERT_TRUE(blocks.open(path_.c_str()).ok());
  blocks.close();
  std::filesystem::resize_file(path_, 0);
  calls.open = [](const char* path, int flags) {
    return (flags & O_ACCMODE) == O_RDONLY ? kernel_open(path, flags) : failing(EROFS);
  };
  expect_refused(OpenResult::failed, EROFS);
}

TEST_F(FileFailures, OtherReasonsNotToOpenAreNoReasonToRead) {
  ASSERT_TRUE(blocks.open(path_.c_str()).ok());
  calls.open = [](const char* path, int flags) {
    return (flags & O_ACCMODE) == O_RDONLY ? kernel_open(path, flags) : failing(EMFILE);
  };
  expect_refused(OpenResult::failed, EMFILE);
}

TEST_F(FileFailures, AFileOfWhichTheSystemTellsNothing) {
  calls.fstat = [](int, struct stat*) { return failing(EOVERFLOW); };
  expect_refused(OpenResult::failed, EOVERFLOW);
}

TEST_F(FileFailures, APipeIsNoStore) {
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  expect_refused(OpenResult::wrong_size, 0);
}

// Some network file systems know no locks.
TEST_F(FileFailures, WhereThereAreNoLocksItOpensAllTheSame) {
  calls.flock = [](int, int) { return failing(ENOLCK); };
  EXPECT_TRUE(blocks.open(path_.c_str()).ok());
}

// --- reading and writing

TEST_F(FileFailures, AFileCutShortBehindOurBackIsNeitherReadNorProgrammed) {
  ASSERT_TRUE(blocks.open(path_.c_str()).ok());
  std::filesystem::resize_file(path_, FileBlocks::kSectorBytes);
  Bytes unit(FileBlocks::kUnitBytes);
  EXPECT_EQ(blocks.read(FileBlocks::kSectorBytes, unit), BlockRead::failed);
  EXPECT_FALSE(blocks.program(FileBlocks::kSectorBytes, {unit.data(), unit.size()}));
  EXPECT_EQ(blocks.read(0, unit), BlockRead::done);
}

TEST_F(FileFailures, AWriteThatFailsIsNoSuccess) {
  ASSERT_TRUE(blocks.open(path_.c_str()).ok());
  const Bytes unit(FileBlocks::kUnitBytes, 0x5A);
  calls.pwrite = [](int, const void*, std::size_t, off_t) -> ssize_t { return failing(EIO); };
  EXPECT_FALSE(blocks.program(0, {unit.data(), unit.size()}));
  EXPECT_FALSE(blocks.erase(1));
  calls.pwrite = nullptr;
  calls.fdatasync = [](int) { return failing(EIO); };
  EXPECT_FALSE(blocks.program(64, {unit.data(), unit.size()}));
  EXPECT_FALSE(blocks.erase(1));
}

// POSIX allows it to any write.
TEST_F(FileFailures, AWriteInPiecesIsFinished) {
  ASSERT_TRUE(blocks.open(path_.c_str()).ok());
  const Bytes units(4 * FileBlocks::kUnitBytes, 0x5A);
  calls.pwrite = [](int fd, const void* bytes, std::size_t size, off_t at) {
    return kernel_pwrite(fd, bytes, std::min<std::size_t>(size, 7), at);
  };
  ASSERT_TRUE(blocks.program(32, {units.data(), units.size()}));
  Bytes read(units.size());
  ASSERT_EQ(blocks.read(32, read), BlockRead::done);
  EXPECT_EQ(read, units);
}

}  // namespace
}  // namespace volcomp::test
