// Recorded bus traffic: the format of candump -L, and the node that does the same again.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comp/tables/image.hpp"
#include "host_sim/host/bus/replay/replay.hpp"
#include "host_sim/host/bus/replay/replayed_node.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/bus/recorded_run.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

std::string complaint(const std::string& text) {
  return sim::complaint_of([&] { return parse_can_log(text, "bus.log"); });
}

TEST(CanLog, ReadsALineOfCandump) {
  const auto log = parse_can_log("(1700000000.123456) vcan0 1A0#1CDF4421020A0F00\n", "bus.log");
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].time_us, 1'700'000'000'123'456U);
  EXPECT_EQ(log[0].frame, (hal::CanFrame{0x1A0, 8, {0x1C, 0xDF, 0x44, 0x21, 2, 10, 15, 0}}));
}

TEST(CanLog, AnyFrameComesBack) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (int i = 0; i < 1000; ++i) {
    hal::CanFrame frame;
    frame.id = static_cast<std::uint16_t>(random() & hal::kMaxCanId);
    frame.size = static_cast<std::uint8_t>(random() % 9);
    for (std::size_t b = 0; b < frame.size; ++b)
      frame.data[b] = static_cast<std::uint8_t>(random());
    const std::uint64_t time_us = random();
    const auto log = parse_can_log(log_line(time_us, "can0", frame), "bus.log");
    ASSERT_EQ(log.size(), 1U);
    EXPECT_EQ(log[0].frame, frame);
    EXPECT_EQ(log[0].time_us, time_us);
  }
}

TEST(CanLog, BadLinesAreNamed) {
  const std::string good = "(0000000001.000000) can0 080#01\n";
  for (const char* bad : {"nonsense", "(1.5) can0 080#01", "(1.000000) can0", "(1.000000) can0 080",
                          "1.000000 can0 080#", "(1.000000) can0 800#01", "(1.000000) can0 08G#01",
                          "(1.000000) can0 080#1", "(1.000000) can0 080#0102030405060708FF",
                          "(x.000000) can0 080#01", "(99999999999999999999.000000) can0 080#01"}) {
    EXPECT_EQ(complaint(good + good + bad), "bus.log:3: not a line of candump -L") << bad;
  }
  EXPECT_EQ(complaint("\n\n"), "bus.log: holds no frames");
}

TEST(CanLog, FramesAreOrderedByTheirTimeStamps) {
  const auto log = parse_can_log(
      "(1.000005) can0 720#00\n(1.000003) can0 000#8100\n(1.000009) can0 080#\n", "bus.log");
  ASSERT_EQ(log.size(), 3U);
  EXPECT_EQ(log[0].frame.id, 0x000);
  EXPECT_EQ(log[1].frame.id, 0x720);
  EXPECT_EQ(log[2].frame.id, 0x080);
}

// NTP sets a clock while candump runs: lines and their spacing show what the stamps do not.
TEST(CanLog, AClockThatIsSetBackIsNotedAndTheSpacingGoesOn) {
  const auto log = parse_can_log(
      "(100.000000) can0 080#01\n(100.000200) can0 201#\n(40.000000) can0 301#\n"
      "(40.000150) can0 302#\n",
      "bus.log");
  ASSERT_EQ(log.size(), 4U);
  EXPECT_EQ(log[2].frame.id, 0x301);
  EXPECT_EQ(log[2].time_us, 100'000'400U);
  EXPECT_EQ(log[2].clock_set_us, -60'000'400);
  EXPECT_EQ(log[3].time_us, 100'000'550U);
  EXPECT_EQ(log[3].clock_set_us, 0);
}

// A small step keeps its lines in order; one line that is late among its neighbours is no step.
TEST(CanLog, AStepIsToldFromALineThatIsLate) {
  std::string text;
  for (int i = 0; i < 40; ++i)
    text += log_line(1'000'000U + 100U * static_cast<unsigned>(i) - (i < 20 ? 0U : 1500U), "can0",
                     {static_cast<std::uint16_t>(0x200 + i), 0, {}}) +
            '\n';
  const auto log = parse_can_log(text, "bus.log");
  for (std::size_t i = 0; i < log.size(); ++i)
    EXPECT_EQ(log[i].frame.id, 0x200 + i);
  EXPECT_EQ(log[20].clock_set_us, -1500);
  EXPECT_EQ(log[39].time_us, 1'003'900U);
}

TEST(CanLog, FramesOfNoUseAreLeftOut) {
  const auto log = parse_can_log(
      "(1.000000) can0 18FF50E5#0102\n(1.000001) can0 123#R\n"
      "(1.000002) can0 20000080#0000000000000000\n(1.000003) can0 123##1AA\n"
      "(1.000004) can0 123#AA\n",
      "bus.log");
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].line, 5U);
}

// --- the log of a run: whole, or the earlier one is still there

constexpr std::size_t kMostOfALog = 1000;
constexpr const char* kLine = "(0000000001.000000) can0 701#05\n";

class CanLogWriterTest : public testing::Test {
 protected:
  void SetUp() override { write_whole_file(path_, "old"); }

  static void write_one(CanLogWriter& log) { log.write(1'000'000, {0x701, 1, {5}}); }
  [[nodiscard]] std::string text() const { return read_whole_file(path_, kMostOfALog); }
  [[nodiscard]] bool is_alone() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()),
                         std::filesystem::directory_iterator()) == 1;
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log";
};

TEST_F(CanLogWriterTest, TakesItsPlaceWhenItIsFinished) {
  CanLogWriter log(path_, "can0");
  write_one(log);
  EXPECT_EQ(text(), "old");
  log.finish();
  EXPECT_EQ(text(), kLine);
  EXPECT_TRUE(is_alone());
}

TEST_F(CanLogWriterTest, UnfinishedItLeavesTheEarlierOne) {
  {
    CanLogWriter log(path_, "can0");
    write_one(log);
  }
  EXPECT_EQ(text(), "old");
  EXPECT_TRUE(is_alone());
}

TEST_F(CanLogWriterTest, AnInterruptedRunLeavesTheEarlierOne) {
  const Interruption survive_the_signal;
  {
    CanLogWriter log(path_, "can0");
    write_one(log);
    ASSERT_EQ(std::raise(SIGTERM), 0);
    EXPECT_THROW(write_one(log), Interrupted);
    EXPECT_THROW(log.finish(), Interrupted);
  }
  EXPECT_EQ(text(), "old");
  EXPECT_TRUE(is_alone());
}

TEST_F(CanLogWriterTest, APipeStays) {
  const std::filesystem::path pipe = folder_.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  CanLogWriter log(pipe, "can0");
  write_one(log);
  log.finish();
  std::array<char, kMostOfALog> got{};
  EXPECT_GT(::read(reader, got.data(), got.size()), 0);
  ::close(reader);
  EXPECT_STREQ(got.data(), kLine);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

// --- replay

constexpr std::uint8_t kNode = 32;

ReplayResult replay_text(const std::string& log, const std::vector<std::uint8_t>& image = {}) {
  return replay(parse_can_log(log, "bus.log"), kNode, image);
}

std::string refusal_of(const std::string& log, const std::vector<std::uint8_t>& image = {}) {
  return sim::complaint_of([&] { return replay_text(log, image); });
}

TEST(Replay, NodeDoesTheSameAgain) {
  const ReplayResult result = replay_text(record_quiet_run());
  EXPECT_TRUE(result.equal()) << describe(result);
  EXPECT_GT(result.cycles, 600U);
  EXPECT_GT(result.compared, 3 * 600U);  // three offsets per cycle at least
  EXPECT_EQ(result.power_ups, 0U);
}

TEST(Replay, CyclesWithoutADriveEndAtTheDeadlineAgain) {
  const ReplayResult result = replay_text(record_drive_failure());
  EXPECT_TRUE(result.equal()) << describe(result);
}

TEST(Replay, PowerCycleOfTheNodeIsRepeated) {
  const ReplayResult result = replay_text(record_power_failure());
  EXPECT_TRUE(result.equal()) << describe(result);
  EXPECT_EQ(result.power_ups, 1U);
}

// --- what a log need not hold: the order of neighbours, and the time

// As candump writes what two processors handled: some lines change places with the next one. The
// stamps stay where they are, so that nothing shows it.
std::vector<LoggedFrame> with_neighbours_exchanged(std::vector<LoggedFrame> log, unsigned seed,
                                                   unsigned percent) {
  std::mt19937 random(seed);
  for (std::size_t i = 0; i + 1 < log.size(); ++i) {
    if (log[i].frame.id == log[i + 1].frame.id || random() % 100 >= percent) continue;
    std::swap(log[i].frame, log[i + 1].frame);
    ++i;
  }
  return log;
}

TEST(Replay, OrderOfNeighboursDoesNotMatter) {
  // In slow cycles the command to start stands next to a SYNC.
  const std::string slow = record_run([](sim::BusAxes&) {}, 0, false, 50.0);
  for (const std::string& text : {record_quiet_run(), record_drive_failure(), slow}) {
    const std::vector<LoggedFrame> log = parse_can_log(text, "bus.log");
    for (unsigned seed = 1; seed <= 100; ++seed) {
      const auto exchanged = with_neighbours_exchanged(log, seed, 1 + seed % 50);
      const ReplayResult result = replay(exchanged, kNode, {});
      EXPECT_TRUE(result.equal()) << seed << ": " << describe(result);
      EXPECT_GT(result.compared, 3 * 600U);
    }
  }
}

// The log with its clock set at some lines, by up to this much.
std::string with_clock_set(const std::string& text, unsigned seed, std::int64_t most_us) {
  std::mt19937 random(seed);
  const std::vector<LoggedFrame> log = parse_can_log(text, "bus.log");
  std::string out;
  std::int64_t shift_us = 1'700'000'000'000'000;
  for (const LoggedFrame& logged : log) {
    if (random() % 500 == 0)
      shift_us += std::uniform_int_distribution<std::int64_t>(-most_us, most_us)(random);
    out +=
        log_line(static_cast<std::uint64_t>(static_cast<std::int64_t>(logged.time_us) + shift_us),
                 "can0", logged.frame) +
        '\n';
  }
  return out;
}

TEST(Replay, AClockThatIsSetDoesNotMatter) {
  for (const std::string& text : {record_quiet_run(), record_drive_failure()}) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
      const std::int64_t most_us = seed % 4 == 0   ? 3'600'000'000
                                   : seed % 4 == 1 ? 2'000'000
                                   : seed % 4 == 2 ? 60'000
                                                   : 900;
      const ReplayResult result = replay_text(with_clock_set(text, seed, most_us));
      EXPECT_TRUE(result.equal()) << seed << ": " << describe(result);
      EXPECT_TRUE(seed % 4 != 0 || !result.clock_set.empty());
    }
  }
}

TEST(Replay, AClockThatIsSetIsNotedWithItsLine) {
  std::string text = record_quiet_run();
  const std::vector<LoggedFrame> log = parse_can_log(text, "bus.log");
  std::string set;
  for (std::size_t i = 0; i < log.size(); ++i)
    set += log_line(log[i].time_us + (i < 3000 ? 90'000'000U : 0U), "can0", log[i].frame) + '\n';
  const ReplayResult result = replay_text(set);
  EXPECT_TRUE(result.equal()) << describe(result);
  ASSERT_EQ(result.clock_set.size(), 1U);
  EXPECT_EQ(result.clock_set[0].line, 3001U);
  EXPECT_NEAR(static_cast<double>(result.clock_set[0].by_us), -90e6, 10e3);
  EXPECT_THAT(describe(result), HasSubstr("line 3001"));
}

// One unit of the wire, 1 nm, in one offset: found in its cycle whatever order the lines have.
TEST(Replay, AnOffsetThatDiffersByOneUnitIsNamed) {
  std::vector<LoggedFrame> log = parse_can_log(record_quiet_run(), "bus.log");
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    std::size_t at = log.size() / 3 + random() % (log.size() / 2);
    while (log[at].frame.id != 0x302)
      ++at;
    std::size_t sync = at;
    while (log[sync].frame.id != 0x080)
      --sync;
    std::vector<LoggedFrame> changed = log;
    const std::uint8_t unit = 1;
    changed[at].frame.data[0] ^= unit;
    for (const bool exchanged : {false, true}) {
      if (exchanged)
        changed = with_neighbours_exchanged(changed, 1000U + static_cast<unsigned>(i), 20);
      const ReplayResult result = replay(changed, kNode, {});
      ASSERT_FALSE(result.equal());
      EXPECT_EQ(result.difference->sync_counter, log[sync].frame.data[0]);
      EXPECT_THAT(result.difference->what, HasSubstr("process data 302h differs"));
      ASSERT_TRUE(result.difference->expected && result.difference->got);
      EXPECT_EQ(result.difference->got->data[0], log[at].frame.data[0]);
      EXPECT_EQ(result.difference->expected->data[0], log[at].frame.data[0] ^ unit);
    }
  }
}

// --- a log that cannot be judged is refused with the place

TEST(Replay, ALogThatLacksASyncIsNotJudgedFromThereOn) {
  std::vector<LoggedFrame> log = parse_can_log(record_quiet_run(), "bus.log");
  std::size_t at = log.size() / 2;
  while (log[at].frame.id != 0x080)
    ++at;
  std::size_t next = at + 1;
  while (log[next].frame.id != 0x080)
    ++next;
  log.erase(log.begin() + static_cast<std::ptrdiff_t>(at),
            log.begin() + static_cast<std::ptrdiff_t>(next));
  const std::string said = sim::complaint_of([&] { return replay(log, kNode, {}); });
  EXPECT_THAT(said, HasSubstr(fmt::format("line {}: SYNC counter", next + 1)));
  EXPECT_THAT(said, HasSubstr("cannot be judged"));
}

TEST(Replay, ALogThatLacksAFrameOfADriveIsNotJudgedFromThereOn) {
  std::vector<LoggedFrame> log = parse_can_log(record_quiet_run(), "bus.log");
  std::size_t at = log.size() / 2;
  while (log[at].frame.id != 0x181)
    ++at;
  log.erase(log.begin() + static_cast<std::ptrdiff_t>(at));
  const std::string said = sim::complaint_of([&] { return replay(log, kNode, {}); });
  EXPECT_THAT(said, HasSubstr("181h"));
  EXPECT_THAT(said, HasSubstr("cannot be judged"));
}

// The line and the SYNC counter of some cycle in the middle of the motion.
struct Place {
  std::size_t line = 0;  // of the target of axis 1, from 0
  std::uint8_t counter = 0;
};
Place find_target(const std::vector<LoggedFrame>& log) {
  Place place;
  int targets = 0;
  for (const LoggedFrame& logged : log) {
    if (logged.frame.id == 0x080) place.counter = logged.frame.data[0];
    place.line = logged.line - 1;
    const bool target = logged.line > log.size() / 2 && logged.frame.id == 0x201;
    if (target && ++targets == 50) return place;
  }
  ADD_FAILURE() << "no such target";
  return place;
}

TEST(Replay, ChangedTargetShowsInItsOwnCycle) {
  std::string text = record_quiet_run();
  const std::vector<LoggedFrame> log = parse_can_log(text, "bus.log");
  const Place place = find_target(log);
  std::size_t at = 0;
  for (std::size_t i = 0; i < place.line; ++i)
    at = text.find('\n', at) + 1;
  // 607Ah: bytes 2…5 of RPDO1; 8.4 mm more or less.
  const std::size_t digit = text.find('#', at) + 1 + 2 * 4 + 1;
  text[digit] = text[digit] == '0' ? '8' : '0';
  const ReplayResult result = replay_text(text);
  ASSERT_FALSE(result.equal());
  EXPECT_EQ(result.difference->sync_counter, place.counter);
  EXPECT_THAT(result.difference->what, HasSubstr("process data 30"));
  ASSERT_TRUE(result.difference->expected);
  ASSERT_TRUE(result.difference->got);
  EXPECT_NE(*result.difference->expected, *result.difference->got);
  EXPECT_THAT(describe(result), HasSubstr(fmt::format("SYNC counter {}", place.counter)));
}

// Without the frames for which `drop` holds.
template <class Drop>
std::vector<LoggedFrame> without(std::vector<LoggedFrame> log, const Drop& drop) {
  log.erase(std::remove_if(log.begin(), log.end(), drop), log.end());
  return log;
}

TEST(Replay, MissingAndAddedAnswersAreDifferences) {
  const std::vector<LoggedFrame> log = parse_can_log(record_quiet_run(), "bus.log");
  std::vector<std::uint16_t> ids{0x301, 0x5A0};
  for (const std::uint16_t id : ids) {
    SCOPED_TRACE(id);
    int seen = 0;
    const auto third = [&seen, id](const LoggedFrame& l) {
      return l.frame.id == id && ++seen == 3;
    };
    EXPECT_FALSE(replay(without(log, third), kNode, {}).equal());
    const auto where = std::find_if(log.rbegin(), log.rend(),
                                    [id](const LoggedFrame& l) { return l.frame.id == id; });
    std::vector<LoggedFrame> twice = log;
    twice.insert(where.base() - log.begin() + twice.begin(), *where);
    EXPECT_FALSE(replay(twice, kNode, {}).equal());
  }
}

// When a status or a heartbeat leaves is a matter of each node's clock.
TEST(Replay, MissingStatusAndHeartbeatsAreNoDifference) {
  const std::vector<LoggedFrame> log =
      parse_can_log(record_run([](sim::BusAxes&) {}, 0, true), "bus.log");
  int seen = 0;
  const auto some = [&seen](const LoggedFrame& l) {
    const bool moment = l.frame.id == 0x1A0 || (l.frame.id == 0x720 && l.frame.data[0] != 0);
    return moment && ++seen % 3 == 0;
  };
  const ReplayResult result = replay(without(log, some), kNode, {});
  EXPECT_TRUE(result.equal()) << describe(result);
  EXPECT_GT(seen, 600);
}

TEST(Replay, LogWithoutTheStartOfTheNodeIsRefused) {
  const std::string text = record_quiet_run();
  EXPECT_THAT(refusal_of(text.substr(text.find('\n', text.size() / 2) + 1)),
              HasSubstr("no start of node 32"));
}

TEST(Replay, LogMayEndAnywhere) {
  const std::vector<LoggedFrame> log = parse_can_log(record_quiet_run(), "bus.log");
  for (std::size_t left_out = 0; left_out < 40; ++left_out) {
    const std::vector<LoggedFrame> shorter(log.begin(),
                                           log.end() - static_cast<std::ptrdiff_t>(left_out));
    const ReplayResult result = replay(shorter, kNode, {});
    EXPECT_TRUE(result.equal()) << left_out << ": " << describe(result);
  }
}

// A node that found its tables in its store: the log shows their CRC and nothing else of them.
TEST(Replay, StoredTablesHaveToBeGiven) {
  const std::vector<std::uint8_t>& image = known_machine().image;
  ImageStorage storage(image);
  ServiceBench bench(&storage);
  bench.pass_us(5000);
  bench.send({0x000, 2, {1, kNode}});
  for (std::uint8_t counter = 1; counter < 10; ++counter)
    bench.send({0x080, 1, {counter}});
  bench.pass_us(200'000);

  EXPECT_THAT(refusal_of(bench.log), HasSubstr("give them with --image"));
  EXPECT_THAT(refusal_of(bench.log),
              HasSubstr(fmt::format("{:08X}", image_crc({image.data(), image.size()}))));
  std::vector<std::uint8_t> other = image;
  other.back() ^= 1U;
  EXPECT_THAT(refusal_of(bench.log, other), HasSubstr("the image given"));
  const ReplayResult result = replay_text(bench.log, image);
  EXPECT_TRUE(result.equal()) << describe(result);
}

TEST(Replay, DownloadUploadAndRefusalAreRepeatedByteForByte) {
  ServiceBench bench;
  bench.pass_us(5000);
  std::vector<std::uint8_t> damaged = known_machine().image;
  damaged[damaged.size() / 2] ^= 1U;
  send_image(bench.client, damaged);
  EXPECT_THROW(arm_tables(bench.client), NodeRefused);
  send_image(bench.client, known_machine().image);
  activate_tables(bench.client);
  EXPECT_EQ(fetch_image(bench.client), known_machine().image);
  bench.send({0x000, 2, {1, kNode}});
  bench.pass_us(200'000);
  const ReplayResult result = replay_text(bench.log);
  EXPECT_TRUE(result.equal()) << describe(result);
}

}  // namespace
}  // namespace volcomp::host
