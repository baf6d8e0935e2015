// The node's end of a frame pipe: hosts that come, go, send too much or nothing sensible, and a
// system that refuses.

#include "hal/linux/node_pipe.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "tests/hal/support.hpp"
#include "tests/hal/system_calls.hpp"

namespace volcomp::test {
namespace {

using hal::NodePipe;
using hal::OpenResult;
using hal::PipeBytes;

constexpr std::uint32_t kTimeout_us = 1'000;

// Both pipes of a folder, from the other side.
class Host {
 public:
  // The node has its end open.
  explicit Host(const std::filesystem::path& folder, bool listens = true)
      : to_node_(::open((folder / hal::kPipeToNode).c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (listens) {
      from_node_ = ::open((folder / hal::kPipeFromNode).c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    }
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  ~Host() {
    ::close(to_node_);
    if (from_node_ >= 0) ::close(from_node_);
  }

  void say(const PipeBytes& record, std::size_t size = hal::kPipeRecordBytes) const {
    EXPECT_EQ(::write(to_node_, record.data(), size), static_cast<ssize_t>(size));
  }
  [[nodiscard]] PipeBytes hear() const {
    PipeBytes record{};
    EXPECT_EQ(::read(from_node_, record.data(), record.size()), ssize_t{hal::kPipeRecordBytes});
    return record;
  }

 private:
  int to_node_;
  int from_node_ = -1;
};

class NodePipeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directory(folder);
  }
  void TearDown() override {
    node.close();
    std::filesystem::remove_all(folder);
  }

  void expect_refused(OpenResult result, int error) {
    const hal::OpenStatus status = node.open(folder.c_str());
    EXPECT_EQ(status.result, result);
    EXPECT_EQ(status.error_number, error);
  }

  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("volcomp_pipe_") +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
  SystemCalls calls;
  NodePipe node;
};

// --- opening

TEST_F(NodePipeTest, MakesItsPipesAndFindsThemAgain) {
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  EXPECT_TRUE(std::filesystem::is_fifo(folder / hal::kPipeToNode));
  EXPECT_TRUE(std::filesystem::is_fifo(folder / hal::kPipeFromNode));
  EXPECT_TRUE(node.open(folder.c_str()).ok());
}

TEST_F(NodePipeTest, AFolderIsNeeded) {
  std::filesystem::remove(folder);
  expect_refused(OpenResult::no_such_folder, ENOENT);
}

TEST_F(NodePipeTest, AFolderThatMayNotBeOpenedIsNotOneThatIsMissing) {
  calls.open = [](const char*, int) { return failing(EACCES); };
  expect_refused(OpenResult::failed, EACCES);
}

TEST_F(NodePipeTest, AFileInPlaceOfAPipeIsRefused) {
  std::ofstream(folder / hal::kPipeToNode) << "a letter";
  expect_refused(OpenResult::not_a_pipe, 0);
}

TEST_F(NodePipeTest, WhatTheSystemRefusesIsPassedOn) {
  for (const char* missing : {hal::kPipeToNode, hal::kPipeFromNode}) {
    calls.mkfifoat = [missing](int, const char* name) {
      return std::strcmp(name, missing) == 0 ? failing(EROFS) : failing(EEXIST);
    };
    expect_refused(OpenResult::failed, EROFS);
  }
  calls.mkfifoat = nullptr;
  calls.openat = [](int, const char*) { return failing(EMFILE); };
  expect_refused(OpenResult::failed, EMFILE);
  calls.openat = nullptr;
  calls.fstat = [](int, struct stat*) { return failing(EIO); };
  expect_refused(OpenResult::not_a_pipe, 0);
}

// --- turns

TEST_F(NodePipeTest, ATurnIsReadAndAnswered) {
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  EXPECT_FALSE(node.begin_turn(kTimeout_us)) << "nobody there yet";
  const Host host(folder);
  EXPECT_FALSE(node.begin_turn(kTimeout_us));
  EXPECT_FALSE(node.ended());
  host.say(hal::pipe_frame(frame(0x123, {1, 2})));
  host.say(hal::pipe_end_of_turn(77));
  ASSERT_TRUE(node.begin_turn(kTimeout_us));
  EXPECT_EQ(node.now_us(), 77U);
  EXPECT_EQ(receive_all(node), std::vector<hal::CanFrame>{frame(0x123, {1, 2})});
  ASSERT_TRUE(node.send(frame(0x456, {3})));
  node.end_turn();
  EXPECT_EQ(host.hear(), hal::pipe_frame(frame(0x456, {3})));
  EXPECT_EQ(host.hear(), hal::pipe_end_of_turn(77));
  host.say(hal::pipe_end_of_turn(78));
  ASSERT_TRUE(node.begin_turn(kTimeout_us));
  EXPECT_EQ(node.now_us(), 78U);
  EXPECT_TRUE(receive_all(node).empty());
}

TEST_F(NodePipeTest, FramesNobodyFetchedAreGoneWithTheConnection) {
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  const Host host(folder);
  host.say(hal::pipe_frame(frame(0x123)));
  host.say(hal::pipe_end_of_turn(1));
  ASSERT_TRUE(node.begin_turn(kTimeout_us));
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  EXPECT_TRUE(receive_all(node).empty());
  EXPECT_EQ(node.now_us(), 0U);
}

// hal/frame_pipe.hpp: the pipe of a turn holds what fits, 4096 frames.
TEST_F(NodePipeTest, MoreFramesThanATurnHoldsEndIt) {
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  const Host host(folder);
  for (std::size_t i = 0; i <= NodePipe::kMostReceived; ++i) {
    host.say(hal::pipe_frame(frame(0x123)));
    EXPECT_FALSE(node.ended());
    EXPECT_FALSE(node.begin_turn(0)) << "no end of turn";
  }
  EXPECT_TRUE(node.ended());
  EXPECT_FALSE(node.begin_turn(0));
}

TEST_F(NodePipeTest, NonsenseQuittingAndHalfARecordEndIt) {
  const PipeBytes nonsense{0x00, 0x08};
  for (const auto& [record, size] :
       {std::pair{nonsense, std::size_t{16}}, std::pair{hal::pipe_quit(), std::size_t{16}},
        std::pair{hal::pipe_end_of_turn(1), std::size_t{9}}}) {
    ASSERT_TRUE(node.open(folder.c_str()).ok());
    EXPECT_FALSE(node.ended());
    const Host host(folder);
    host.say(record, size);
    EXPECT_FALSE(node.begin_turn(kTimeout_us));
    EXPECT_TRUE(node.ended());
    EXPECT_FALSE(node.send(frame(0x123)));
  }
}

TEST_F(NodePipeTest, AHostThatDoesNotListenEndsIt) {
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  const Host host(folder, false);
  host.say(hal::pipe_end_of_turn(1));
  EXPECT_FALSE(node.begin_turn(kTimeout_us));
  EXPECT_TRUE(node.ended());
}

TEST_F(NodePipeTest, AnAnswerThatWouldGoIntoAFileEndsIt) {
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  const Host host(folder);
  std::filesystem::remove(folder / hal::kPipeFromNode);
  std::ofstream(folder / hal::kPipeFromNode) << "a letter";
  host.say(hal::pipe_end_of_turn(1));
  EXPECT_FALSE(node.begin_turn(kTimeout_us));
  EXPECT_TRUE(node.ended());
  EXPECT_EQ(std::filesystem::file_size(folder / hal::kPipeFromNode), 8U) << "left alone";
}

// --- interruptions

TEST_F(NodePipeTest, ASignalInterruptsNoTurn) {
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  const Host host(folder);
  host.say(hal::pipe_end_of_turn(5));
  int error = EINTR;
  calls.read = [&](int, void* bytes, std::size_t) -> ssize_t {
    if (error != 0) return failing(std::exchange(error, error == EINTR ? EAGAIN : 0));
    const PipeBytes end = hal::pipe_end_of_turn(5);
    std::memcpy(bytes, end.data(), end.size());
    return ssize_t{hal::kPipeRecordBytes};
  };
  ASSERT_TRUE(node.begin_turn(kTimeout_us));
  int interruptions = 2;
  calls.write = [&](int, const void*, std::size_t size) -> ssize_t {
    return interruptions-- > 0 ? failing(EINTR) : static_cast<int>(size);
  };
  EXPECT_TRUE(node.send(frame(0x123)));
  EXPECT_EQ(interruptions, -1);
}

TEST_F(NodePipeTest, ErrorsOfThePipeEndIt) {
  for (const bool reading : {true, false}) {
    calls.read = nullptr;
    calls.write = nullptr;
    ASSERT_TRUE(node.open(folder.c_str()).ok());
    const Host host(folder);
    host.say(hal::pipe_end_of_turn(5));
    if (reading) calls.read = [](int, void*, std::size_t) -> ssize_t { return failing(EIO); };
    EXPECT_EQ(node.begin_turn(kTimeout_us), !reading);
    calls.write = [](int, const void*, std::size_t) -> ssize_t { return failing(EPIPE); };
    EXPECT_FALSE(node.send(frame(0x123)));
    EXPECT_TRUE(node.ended());
  }
}

// Records are whole or the pipe is broken.
TEST_F(NodePipeTest, HalfARecordWrittenEndsIt) {
  ASSERT_TRUE(node.open(folder.c_str()).ok());
  const Host host(folder);
  host.say(hal::pipe_end_of_turn(5));
  ASSERT_TRUE(node.begin_turn(kTimeout_us));
  calls.write = [](int, const void*, std::size_t) -> ssize_t { return 5; };
  EXPECT_FALSE(node.send(frame(0x123)));
  EXPECT_TRUE(node.ended());
}

}  // namespace
}  // namespace volcomp::test
