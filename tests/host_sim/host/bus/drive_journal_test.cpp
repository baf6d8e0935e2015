// The journal of a drive that is changed for a while: what is on the disk when.

#include <gmock/gmock.h>

#include <fstream>

#include "host_sim/host/bus/drive_check/drive_journal.hpp"
#include "host_sim/host/bus/drive_check/drive_restore.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "tests/complaint.hpp"

namespace volcomp::host {
namespace {

using sim::complaint_of;
using testing::HasSubstr;

constexpr canopen::ObjectId kCobId{0x1403, 1};
constexpr canopen::ObjectId kCount{0x1603, 0};
constexpr canopen::ObjectId kEntry{0x1603, 1};

JournalOwner owner_on(const std::string& bus) {
  return {bus, 3, {0x9A, 0x30924, 0x10420, 0xFFFFFFFF}};
}

std::string text_of(const std::filesystem::path& path) { return read_whole_file(path, 100'000); }

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

class Journals : public testing::Test {
 protected:
  // One that a killed call has left.
  std::string leave() {
    DriveJournal journal = DriveJournal::create(path, owner_on("can0"));
    journal.keep({{kCobId, {0x03, 0x05, 0, 0}, {}}, {kCount, {2}, {}}});
    journal.announce(kCobId, {0x03, 0x05, 0, 0x80});
    journal.announce(kCount, {0});
    journal.keep({{kEntry, {0x10, 0, 0x40, 0x60}, {}}});
    journal.announce(kEntry, {0x20, 0, 0xB0, 0x60});
    return text_of(path);
  }

  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "state" / "can0-3.journal";
};

TEST_F(Journals, IsReadAsItWasWritten) {
  const auto content = read_journal(leave());
  ASSERT_TRUE(content);
  EXPECT_EQ(content->owner.bus, "can0");
  EXPECT_EQ(content->owner.node, 3);
  EXPECT_EQ(content->owner.identity, owner_on("can0").identity);
  ASSERT_EQ(content->objects.size(), 3U);
  EXPECT_EQ(content->objects[0].object, kCobId);
  EXPECT_EQ(content->objects[0].before, (SdoChannel::Bytes{0x03, 0x05, 0, 0}));
  EXPECT_EQ(content->objects[2].written, (std::vector<SdoChannel::Bytes>{{0x20, 0, 0xB0, 0x60}}));
}

// Each value is there before the call returns, so before the drive is written.
TEST_F(Journals, HoldsAValueBeforeItIsOverwritten) {
  DriveJournal journal = DriveJournal::create(path, owner_on("can0"));
  journal.keep({{kCount, {7}, {}}});
  EXPECT_EQ(read_journal(text_of(path))->objects.at(0).before, SdoChannel::Bytes{7});
  EXPECT_TRUE(read_journal(text_of(path))->objects.at(0).written.empty());
  journal.announce(kCount, {0});
  EXPECT_EQ(read_journal(text_of(path))->objects.at(0).written.at(0), SdoChannel::Bytes{0});
}

// Cut anywhere, what is read is the beginning of what was written.
TEST_F(Journals, IsReadAsFarAsItIsWhole) {
  const std::string text = leave();
  const auto all = read_journal(text);
  std::size_t objects_before = 0;
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const auto part = read_journal(text.substr(0, size));
    if (!part) {
      EXPECT_EQ(objects_before, 0U) << size;
      continue;
    }
    EXPECT_EQ(part->owner.identity, all->owner.identity);
    ASSERT_LE(part->objects.size(), all->objects.size());
    EXPECT_GE(part->objects.size(), objects_before) << size;
    objects_before = part->objects.size();
    for (std::size_t i = 0; i < part->objects.size(); ++i) {
      EXPECT_EQ(part->objects[i].object, all->objects[i].object);
      EXPECT_EQ(part->objects[i].before, all->objects[i].before);
    }
  }
  EXPECT_EQ(objects_before, 3U);
}

// Whatever stands in the last line in place of a byte of it.
TEST_F(Journals, ADamagedLastLineIsNone) {
  const std::string text = leave();
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
  for (std::size_t at = last; at < text.size(); ++at) {
    std::string damaged = text;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
    const auto content = read_journal(damaged);
    ASSERT_TRUE(content);
    ASSERT_EQ(content->objects.size(), 3U);
    EXPECT_TRUE(content->objects[2].written.empty()) << at;
  }
}

TEST_F(Journals, ATornOneIsContinuedBehindItsLastWholeLine) {
  const std::string text = leave();
  write_text(path, text.substr(0, text.size() - 3));
  auto journal = DriveJournal::open(path);
  ASSERT_TRUE(journal);
  journal->announce(kEntry, {0x20, 0, 0x7A, 0x60});
  EXPECT_EQ(read_journal(text_of(path))->objects.at(2).written.size(), 1U);
}

TEST_F(Journals, OneThatNamesNoChangeIsRemoved) {
  { const DriveJournal journal = DriveJournal::create(path, owner_on("can0")); }
  EXPECT_FALSE(DriveJournal::open(path));
  EXPECT_FALSE(std::filesystem::exists(path));
  write_text(path, "volcomp-dr");
  EXPECT_FALSE(DriveJournal::open(path));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Journals, AnotherFileIsNotRemoved) {
  std::filesystem::create_directories(path.parent_path());
  write_text(path, "my notes\n");
  EXPECT_THAT(complaint_of([&] { return DriveJournal::open(path); }),
              HasSubstr("is no journal of a drive"));
  EXPECT_THAT(complaint_of([&] { return DriveJournal::create(path, owner_on("can0")); }),
              HasSubstr("is there already"));
  EXPECT_EQ(text_of(path), "my notes\n");
}

TEST_F(Journals, ARunningCommandKeepsItsOwn) {
  DriveJournal journal = DriveJournal::create(path, owner_on("can0"));
  journal.keep({{kCount, {7}, {}}});
  EXPECT_THAT(complaint_of([&] { return DriveJournal::open(path); }),
              HasSubstr("another command works with this drive"));
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST_F(Journals, AreFoundInTheirFolder) {
  leave();
  write_text(path.parent_path() / "note.txt", "");
  EXPECT_EQ(journals_in(path.parent_path()), std::vector{path});
  EXPECT_TRUE(journals_in(folder.path() / "none").empty());
}

TEST_F(Journals, AnyNameOfABusIsKept) {
  for (const std::string bus : {"pipe:/tmp/a b", "slcan:/dev/tty%20\n", "can0 can1", ""}) {
    {
      DriveJournal journal = DriveJournal::create(path, owner_on(bus));
      journal.keep({{kCount, {7}, {}}});
    }
    EXPECT_EQ(read_journal(text_of(path))->owner.bus, bus);
    DriveJournal::open(path)->remove();
  }
  EXPECT_EQ(journal_name("can0", 3), "can0-3.journal");
  EXPECT_NE(journal_name("pipe:/a", 3), journal_name("pipe:/b", 3));
  EXPECT_THAT(journal_name("pipe:/a", 3), Not(HasSubstr("/")));
}

// The order of CiA 301, 7.5.2.36, and the COB-ID last.
TEST_F(Journals, TheListOfWritesRestores) {
  std::vector<std::string> lines;
  for (const SdoWrite& write : restoring_writes(read_journal(leave())->objects))
    lines.push_back(describe(write));
  EXPECT_EQ(lines, (std::vector<std::string>{"1403h:01 = 80000503h", "1603h:00 = 00h",
                                             "1603h:01 = 60400010h", "1603h:00 = 02h",
                                             "1403h:01 = 00000503h"}));
}

}  // namespace
}  // namespace volcomp::host
