// Files that appear whole or not at all, what stands in their place, and files read no further than
// need be.

#include <fcntl.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>

#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/file_draft.hpp"
#include "host_sim/host/io/interruption.hpp"
#include "host_sim/host/io/parallel.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/toml_text.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kEnough = 1000;

class WholeFileTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] std::string text(const std::string& name) const {
    return read_whole_file(path(name), kEnough);
  }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(WholeFileTest, ALinkStaysAndTheFileBehindItIsReplaced) {
  write_whole_file(path("real"), "old");
  fs::create_symlink("real", path("link"));
  fs::create_symlink(path("link"), path("link to link"));
  write_whole_file(path("link to link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link to link")));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_FALSE(fs::is_symlink(path("real")));
  EXPECT_EQ(text("real"), "new");
  EXPECT_EQ(entries(), 3);
}

TEST_F(WholeFileTest, ALinkToAFileToComeGetsIt) {
  fs::create_directory(path("folder"));
  fs::create_symlink("folder/real", path("link"));
  write_whole_file(path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(text("folder/real"), "new");
}

TEST_F(WholeFileTest, LinksInACircleAreRefused) {
  fs::create_symlink("b", path("a"));
  fs::create_symlink("a", path("b"));
  EXPECT_EQ(sim::complaint_of([&] { write_whole_file(path("a"), "new"); }),
            path("a").string() + ": cannot be written");
}

TEST_F(WholeFileTest, TheModeOfAnEarlierFileIsKept) {
  for (const unsigned mode : {0600U, 0664U, 0755U}) {
    write_whole_file(path("file"), "old");
    fs::permissions(path("file"), static_cast<fs::perms>(mode));
    write_whole_file(path("file"), "new");
    EXPECT_EQ(static_cast<unsigned>(fs::status(path("file")).permissions()), mode);
  }
}

// For root, too.
TEST_F(WholeFileTest, AFileThatNobodyMayWriteIsRefused) {
  write_whole_file(path("file"), "old");
  fs::permissions(path("file"), static_cast<fs::perms>(0444));
  EXPECT_EQ(sim::complaint_of([&] { write_whole_file(path("file"), "new"); }),
            path("file").string() + ": cannot be written");
  EXPECT_EQ(text("file"), "old");
  EXPECT_EQ(entries(), 1);
}

// What a draft or a folder would be refused for is known before there is anything to write.
TEST_F(WholeFileTest, WhatHasNoPlaceIsRefusedBeforeItIsWritten) {
  write_whole_file(path("file"), "old");
  write_whole_file(path("kept"), "old");
  fs::permissions(path("kept"), static_cast<fs::perms>(0444));
  fs::create_directory(path("folder"));
  fs::create_symlink("folder/new", path("link"));
  fs::create_symlink("none/new", path("lost"));
  for (const char* name : {"file", "new", "folder/new", "link"})
    EXPECT_NO_THROW(require_place(path(name))) << name;
  for (const char* name : {"kept", "folder", "none/new", "lost", "file/new"})
    EXPECT_EQ(sim::complaint_of([&] { require_place(path(name)); }),
              path(name).string() + ": cannot be written");
  EXPECT_NO_THROW(require_place("/dev/null"));
  for (const char* name : {"folder", "new", "new/inner"})
    EXPECT_NO_THROW(require_folder(path(name))) << name;
  for (const char* name : {"file", "file/new", "file/new/inner"})
    EXPECT_EQ(sim::complaint_of([&] { require_folder(path(name)); }),
              path(name).string() + ": cannot be created or written");
  EXPECT_EQ(text("file"), "old");
  EXPECT_EQ(entries(), 5);
}

TEST_F(WholeFileTest, APipeIsWrittenAndStays) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  write_whole_file(path("pipe"), "new");
  std::array<char, kEnough> got{};
  EXPECT_EQ(::read(reader, got.data(), got.size()), 3);
  ::close(reader);
  EXPECT_STREQ(got.data(), "new");
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_EQ(entries(), 1);
}

TEST_F(WholeFileTest, ADeviceBehindALinkStays) {
  fs::create_symlink("/dev/null", path("nothing"));
  write_whole_file(path("nothing"), "new");
  EXPECT_TRUE(fs::is_symlink(path("nothing")));
  EXPECT_TRUE(fs::is_character_file(path("nothing")));
  EXPECT_EQ(entries(), 1);
}

// The opener of the file sees what is written to the descriptor.
TEST_F(WholeFileTest, ADescriptorIsWrittenAndItsFileStays) {
  const int open_file = ::open(path("file").c_str(), O_RDWR | O_CREAT, 0600);
  ASSERT_GE(open_file, 0);
  fs::create_symlink(fs::path("/proc/self/fd") / std::to_string(open_file), path("link"));
  write_whole_file(path("link"), "new");
  std::array<char, kEnough> got{};
  EXPECT_EQ(::pread(open_file, got.data(), got.size(), 0), 3);
  ::close(open_file);
  EXPECT_STREQ(got.data(), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
}

TEST_F(WholeFileTest, OfSeveralNoneIsPutInPlaceBeforeAllAreWritten) {
  write_whole_file(path("first"), "old");
  {
    WholeFiles files;
    files.add(path("first"), "new");
    files.add_folder(path("folder/inner"));
    files.add(path("folder/inner/second"), "new");
    EXPECT_EQ(sim::complaint_of([&] { files.add(path("none/third"), "new"); }),
              path("none/third").string() + ": cannot be written");
  }
  EXPECT_EQ(text("first"), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(WholeFileTest, ADeviceThatFailsLeavesTheFilesAsTheyWere) {
  write_whole_file(path("first"), "old");
  fs::create_symlink("/dev/full", path("full"));
  {
    WholeFiles files;
    files.add(path("first"), "new");
    files.add(path("full"), "new");
    EXPECT_EQ(sim::complaint_of([&] { files.put_in_place(); }),
              path("full").string() + ": cannot be written");
  }
  EXPECT_EQ(text("first"), "old");
  EXPECT_EQ(entries(), 2);
}

TEST_F(WholeFileTest, SeveralAppearTogether) {
  fs::create_directory(path("old folder"));
  {
    WholeFiles files;
    files.add_folder(path("folder"));
    files.add_folder(path("old folder"));
    files.add(path("folder/first"), "1");
    files.add(path("second"), "2");
    EXPECT_FALSE(fs::exists(path("second")));
    files.put_in_place();
  }
  EXPECT_EQ(text("folder/first"), "1");
  EXPECT_EQ(text("second"), "2");
  EXPECT_TRUE(fs::exists(path("old folder")));
}

// --- the name of a draft is not that of anything else

[[nodiscard]] std::string draft_name(const fs::path& path) {
  return path.string() + "." + std::to_string(::getpid()) + ".tmp";
}

TEST_F(WholeFileTest, ALinkWithTheNameOfTheDraftIsNotFollowed) {
  write_whole_file(path("victim"), "precious");
  fs::create_symlink(path("victim"), draft_name(path("file")));
  write_whole_file(path("file"), "new");
  EXPECT_EQ(text("victim"), "precious");
  EXPECT_EQ(text("file"), "new");
  EXPECT_FALSE(fs::is_symlink(path("file")));
  EXPECT_TRUE(fs::is_symlink(draft_name(path("file"))));
}

TEST_F(WholeFileTest, AFileWithTheNameOfTheDraftStays) {
  write_whole_file(draft_name(path("file")), "of another");
  write_whole_file(path("file"), "new");
  EXPECT_EQ(read_whole_file(draft_name(path("file")), kEnough), "of another");
  EXPECT_EQ(text("file"), "new");
  EXPECT_EQ(entries(), 2);
}

// --- a signal ends the program, but leaves no draft

class SignalTest : public WholeFileTest, public testing::WithParamInterface<int> {};

TEST_P(SignalTest, LeavesNoDraft) {
  write_whole_file(path("file"), "old");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    static_cast<void>(std::signal(GetParam(), SIG_DFL));  // also under nohup
    WholeFiles files;
    files.add(path("file"), "new");
    files.add(path("second"), "new");
    files.add_folder(path("folder/inner"));
    files.add(path("folder/inner/third"), "new");
    static_cast<void>(std::raise(GetParam()));
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), GetParam());
  EXPECT_EQ(text("file"), "old");
  EXPECT_EQ(entries(), 1);
}

INSTANTIATE_TEST_SUITE_P(Signals, SignalTest, testing::Values(SIGINT, SIGTERM, SIGHUP));

// Sent the moment a draft appears: a signal between its creation and its registration comes later,
// also where another thread than the one that creates it receives the signal.
class DraftsOfThreads : public WholeFileTest, public testing::WithParamInterface<bool> {};

TEST_P(DraftsOfThreads, ASignalAtTheCreationOfADraftLeavesNone) {
  constexpr int kTimes = 50;
  const int changes = ::inotify_init1(IN_CLOEXEC);
  ASSERT_GE(changes, 0);
  ASSERT_GE(::inotify_add_watch(changes, path("").c_str(), IN_CREATE), 0);
  for (int i = 0; i < kTimes; ++i) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const auto create = [this](std::size_t) {
        for (;;)
          const FileDraft draft(path("file"));
      };
      const bool by_another_thread = GetParam();
      if (!by_another_thread) create(0);
      in_parallel(2, 2, [&create, caller = std::this_thread::get_id()](std::size_t part) {
        if (std::this_thread::get_id() != caller) create(part);
        for (;;)
          static_cast<void>(::pause());
      });
    }
    std::array<char, 4096> event{};
    EXPECT_GT(::read(changes, event.data(), event.size()), 0);
    static_cast<void>(::kill(child, SIGTERM));
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
    ASSERT_EQ(entries(), 0);
    // What the child did before it ended.
    while (::ioctl(changes, FIONREAD, &status) == 0 && status > 0)
      EXPECT_GT(::read(changes, event.data(), event.size()), 0);
  }
  ::close(changes);
}

INSTANTIATE_TEST_SUITE_P(, DraftsOfThreads, testing::Bool());

// The second signal ends a program that was to end in order and is stuck.
TEST_F(WholeFileTest, ASecondSignalLeavesNoDraft) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const Interruption interruption;
    WholeFiles files;
    files.add(path("file"), "new");
    static_cast<void>(std::raise(SIGTERM));
    static_cast<void>(std::raise(SIGTERM));
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(entries(), 0);
}

// --- reading

TEST(ReadingFiles, WhyAFileCannotBeOpenedIsSaid) {
  const TemporaryFolder folder;
  const fs::path none = folder.path() / "none";
  EXPECT_EQ(sim::complaint_of([&] { return read_whole_file(none, kEnough); }),
            none.string() + ": cannot be opened: No such file or directory");
  EXPECT_EQ(sim::complaint_of([&] { return read_whole_file(folder.path(), kEnough); }),
            folder.path().string() + ": cannot be opened: Is a directory");
}

// The memory of a process has no first byte.
TEST(ReadingFiles, WhatCannotBeReadIsNotTakenForItsEnd) {
  const fs::path unreadable = "/proc/self/mem";
  const std::string complaint = "/proc/self/mem: cannot be read";
  EXPECT_EQ(sim::complaint_of([&] { return read_whole_file(unreadable, kEnough); }), complaint);
  EXPECT_EQ(sim::complaint_of([&] { return text_of_file(unreadable); }), complaint);
  EXPECT_EQ(sim::complaint_of([&] { return read_image_file(unreadable); }), complaint);
}

TEST(ReadingFiles, NoMoreIsReadThanShowsThatItIsTooMuch) {
  constexpr std::size_t kMiB = std::size_t{1} << 20U;
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "large.toml";
  write_whole_file(path, "");
  fs::resize_file(path, 8 * kMiB);
  const std::string text = text_of_file(path);
  EXPECT_EQ(text.size(), kMiB + 1);
  EXPECT_THAT(sim::complaint_of([&] { return parse_toml(text, "large.toml"); }),
              testing::HasSubstr("larger than 1 MiB"));
}

// Where assertions are on, toml++ ended the program here (found by a fuzz program).
TEST(ReadingFiles, ACommentInPlaceOfANameOfATableIsNotToml) {
  EXPECT_EQ(sim::complaint_of([&] { return parse_toml("\n[#", "m.toml"); }),
            "m.toml:2: not valid TOML");
}

}  // namespace
}  // namespace volcomp::host
