// Programs started by this one: QEMU, and here the shell.

#include "host_sim/sim/boards/child_process.hpp"

#include <csignal>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/sim/boards/emulated_node.hpp"
#include "tests/complaint.hpp"

namespace volcomp::sim {
namespace {

using testing::HasSubstr;

constexpr int kLong_ms = 60'000;

struct Shell {
  explicit Shell(const std::string& script)
      : process({find_program("sh"), "-c", script}, folder.path(), folder.path() / "output.txt") {}

  [[nodiscard]] std::string said() const {
    std::ifstream stream(folder.path() / "output.txt");
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  host::TemporaryFolder folder;
  ChildProcess process;
};

TEST(ChildProcess, RunsInItsFolderAndIsHeard) {
  Shell shell("pwd; echo trouble >&2; cat");
  ASSERT_TRUE(shell.process.await_end(kLong_ms));
  EXPECT_TRUE(shell.process.ended_well());
  EXPECT_EQ(shell.said(), shell.folder.path().string() + "\ntrouble\n");
}

TEST(ChildProcess, ExitCodeIsTold) {
  Shell shell("exit 99");
  ASSERT_TRUE(shell.process.await_end(kLong_ms));
  EXPECT_FALSE(shell.process.ended_well());
  EXPECT_EQ(shell.process.how_it_ended(), "ended with exit code 99");
}

TEST(ChildProcess, SignalIsTold) {
  Shell shell("kill -9 $$");
  ASSERT_TRUE(shell.process.await_end(kLong_ms));
  EXPECT_EQ(shell.process.how_it_ended(), "was ended by signal 9 (Killed)");
}

TEST(ChildProcess, EndsWithItsOwner) {
  pid_t id = -1;
  {
    Shell shell("while true; do sleep 1; done");
    EXPECT_TRUE(shell.process.running());
    EXPECT_FALSE(shell.process.await_end(0));
    id = shell.process.id();
    EXPECT_EQ(::kill(id, 0), 0);
  }
  EXPECT_NE(::kill(id, 0), 0);
}

TEST(ChildProcess, ProgramsAreFoundAsByTheShell) {
  EXPECT_EQ(find_program("sh").filename(), "sh");
  EXPECT_TRUE(find_program("no-such-program-anywhere").empty());
}

TEST(Interruption, IsNoticedByWhoLooks) {
  const host::Interruption interruption;
  EXPECT_NO_THROW(interruption.check());
  ASSERT_EQ(std::raise(SIGTERM), 0);
  try {
    interruption.check();
    FAIL() << "nothing was thrown";
  } catch (const host::Interrupted& interrupted) {
    EXPECT_EQ(interrupted.signal, SIGTERM);
  }
}

TEST(Interruption, OneInsideAnotherDoesNotForget) {
  const host::Interruption outer;
  ASSERT_EQ(std::raise(SIGTERM), 0);
  { const host::Interruption inner; }
  EXPECT_TRUE(outer.asked());
}

TEST(Interruption, TheSecondSignalEndsWhoDoesNotLook) {
  const auto stuck = [] {
    const host::Interruption interruption;
    static_cast<void>(std::raise(SIGINT));
    static_cast<void>(std::raise(SIGINT));
  };
  EXPECT_EXIT(stuck(), testing::KilledBySignal(SIGINT), "");
}

TEST(Interruption, NobodyHangsUpWhatNohupStarted) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  {
    const host::Interruption interruption;
    ASSERT_EQ(std::raise(SIGHUP), 0);
    EXPECT_FALSE(interruption.asked());
  }
  static_cast<void>(std::signal(SIGHUP, before));
}

TEST(EmulatedNode, WhatIsMissingIsNamed) {
  const auto complaint = [](const std::string& board, const std::string& image) {
    return complaint_of([&] { const EmulatedNode node(emulated_board(board), image); });
  };
  EXPECT_THAT(complaint("m3", ""), HasSubstr("m3: there is no firmware"));
  EXPECT_EQ(complaint("m7", "/no/such.elf"), "/no/such.elf: no such file");
  EXPECT_THAT(complaint("a53", "/bin/sh"), HasSubstr("a53: has a CAN controller of its own"));
  EXPECT_THAT(node_image(emulated_board("m4")).string(),
              testing::EndsWith("/m4/firmware/volcomp-node-m4.elf"));
}

}  // namespace
}  // namespace volcomp::sim
