// A log replayed into a node behind a frame pipe: what a node in this process did, it does too.

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "host_sim/host/bus/links/boot_up.hpp"
#include "host_sim/host/bus/replay/replay.hpp"
#include "host_sim/host/bus/table_transfer.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "tests/host_sim/host/bus/linux_node.hpp"
#include "tests/host_sim/host/bus/recorded_run.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

// One node after the other, each freshly started.
class Nodes {
 public:
  ReplayResult replay(const std::vector<LoggedFrame>& log) {
    return replay_over_pipe(log, kLinuxNode, [this] { return start(); });
  }
  ReplayResult replay(const std::string& log) { return replay(parse_can_log(log, "bus.log")); }
  [[nodiscard]] int started() const { return started_; }

 private:
  std::shared_ptr<PipeLink> start() {
    node_.reset();
    node_ = std::make_unique<PipeNode>(folder_.path());
    auto link = std::make_shared<PipeLink>(folder_.path());
    EXPECT_TRUE(await_boot_up(*link));
    ++started_;
    return link;
  }

  TemporaryFolder folder_;
  std::unique_ptr<PipeNode> node_;
  int started_ = 0;
};

TEST(ReplayOverPipe, NodeDoesTheSame) {
  Nodes nodes;
  const ReplayResult result = nodes.replay(record_quiet_run());
  EXPECT_TRUE(result.equal()) << describe(result);
  EXPECT_GT(result.cycles, 600U);
  EXPECT_GT(result.compared, 3 * 600U);
  EXPECT_EQ(nodes.started(), 1);
}

TEST(ReplayOverPipe, DeadlinesAreKept) {
  Nodes nodes;
  const ReplayResult result = nodes.replay(record_drive_failure());
  EXPECT_TRUE(result.equal()) << describe(result);
}

TEST(ReplayOverPipe, PowerCycleStartsAnotherNode) {
  Nodes nodes;
  const ReplayResult result = nodes.replay(record_power_failure());
  EXPECT_TRUE(result.equal()) << describe(result);
  EXPECT_EQ(result.power_ups, 1U);
  EXPECT_EQ(nodes.started(), 2);
}

TEST(ReplayOverPipe, DownloadAndRefusalAreRepeatedByteForByte) {
  ServiceBench bench;
  bench.pass_us(5000);
  std::vector<std::uint8_t> damaged = known_machine().image;
  damaged[damaged.size() / 2] ^= 1U;
  send_image(bench.client, damaged);
  EXPECT_THROW(arm_tables(bench.client), NodeRefused);
  send_image(bench.client, known_machine().image);
  activate_tables(bench.client);
  EXPECT_EQ(fetch_image(bench.client), known_machine().image);
  bench.send({0x000, 2, {1, kLinuxNode}});
  bench.pass_us(200'000);
  Nodes nodes;
  const ReplayResult result = nodes.replay(bench.log);
  EXPECT_TRUE(result.equal()) << describe(result);
}

// A started node may report its state before the first SYNC or after it; when both reach it in the
// same turn, its first status is that of the first cycle.
TEST(ReplayOverPipe, StatusOfTheStartMayComeEarlyOrNotButNotWrong) {
  const std::vector<LoggedFrame> log = parse_can_log(record_quiet_run(), "bus.log");
  const auto first = [&log](std::uint16_t id, std::size_t from) {
    const auto it = std::find_if(log.begin() + static_cast<std::ptrdiff_t>(from), log.end(),
                                 [id](const LoggedFrame& l) { return l.frame.id == id; });
    return static_cast<std::size_t>(it - log.begin());
  };
  std::size_t start = first(0x000, 0);
  while (log.at(start).frame != hal::CanFrame{0x000, 2, {1, kLinuxNode}})
    start = first(0x000, start + 1);
  const std::size_t sync = first(0x080, start);
  const std::size_t status = first(0x1A0, start);
  ASSERT_NE(status, sync);
  ASSERT_EQ(log.at(status).frame.data[5], 0) << "a SYNC counter: not the status of the start";

  std::vector<LoggedFrame> changed = log;
  changed[status].frame.data[4] ^= 1U;
  EXPECT_FALSE(Nodes().replay(changed).equal());

  changed = log;
  changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(status));
  const ReplayResult without = Nodes().replay(changed);
  EXPECT_TRUE(without.equal()) << describe(without);

  // On the other side of that SYNC.
  const bool late = status > sync;
  LoggedFrame moved = log[status];
  moved.time_us = late ? log[start].time_us + 1 : log[sync].time_us + 1;
  changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(sync), moved);
  const ReplayResult other = Nodes().replay(changed);
  EXPECT_TRUE(other.equal()) << describe(other);
}

// One byte of one frame of the node, each kind of frame in turn.
TEST(ReplayOverPipe, EveryChangedAnswerIsADifference) {
  const std::vector<LoggedFrame> log = parse_can_log(record_quiet_run(), "bus.log");
  const std::vector<std::uint16_t> ids{0x301, 0x303, 0x5A0, 0x1A0};
  for (const std::uint16_t id : ids) {
    SCOPED_TRACE(id);
    std::vector<LoggedFrame> changed = log;
    const auto last = std::find_if(changed.rbegin(), changed.rend(),
                                   [id](const LoggedFrame& l) { return l.frame.id == id; });
    ASSERT_NE(last, changed.rend());
    last->frame.data[0] ^= 1U;
    const ReplayResult result = Nodes().replay(changed);
    ASSERT_FALSE(result.equal());
    EXPECT_EQ(result.difference->line, last->line);
  }
}

TEST(ReplayOverPipe, AnswersNobodyGaveAreDifferences) {
  const std::vector<LoggedFrame> log = parse_can_log(record_quiet_run(), "bus.log");
  const std::vector<std::uint16_t> ids{0x301, 0x5A0};
  for (const std::uint16_t id : ids) {
    SCOPED_TRACE(id);
    std::vector<LoggedFrame> more = log;
    const auto where =
        std::find_if(more.begin() + static_cast<std::ptrdiff_t>(more.size() / 2), more.end(),
                     [](const LoggedFrame& l) { return l.frame.id == 0x080; });
    LoggedFrame invented = *where;
    invented.frame = {id, 4, {1, 2, 3, 4}};
    more.insert(where, invented);
    EXPECT_FALSE(Nodes().replay(more).equal());
  }
}

TEST(ReplayOverPipe, NodeThatDiesIsNamed) {
  const TemporaryFolder folder;
  std::unique_ptr<PipeNode> node;
  int starts = 0;
  const auto start = [&] {
    ++starts;
    node = std::make_unique<PipeNode>(folder.path());
    auto link = std::make_shared<PipeLink>(folder.path());
    EXPECT_TRUE(await_boot_up(*link));
    node.reset();
    return link;
  };
  try {
    static_cast<void>(
        replay_over_pipe(parse_can_log(record_quiet_run(), "bus.log"), kLinuxNode, start));
    FAIL() << "nothing was thrown";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is gone"));
  }
  EXPECT_EQ(starts, 1);
}

}  // namespace
}  // namespace volcomp::host
