// Links to nodes that are not in this process, with a node at the other end.

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "host_sim/host/bus/diagnosis.hpp"
#include "host_sim/host/bus/links/paced_link.hpp"
#include "host_sim/host/bus/links/pipe_link.hpp"
#include "host_sim/host/bus/links/slcan_link.hpp"
#include "host_sim/host/io/temporary_folder.hpp"
#include "host_sim/host/io/user_error.hpp"
#include "host_sim/host/io/whole_file.hpp"
#include "tests/complaint.hpp"
#include "tests/host_sim/host/bus/linux_node.hpp"

namespace volcomp::host {
namespace {

using testing::HasSubstr;

std::string refusal_of(const std::string& name) {
  return sim::complaint_of([&] { return open_frame_link(name); });
}

// Heartbeat and product code (1018h:02), as any other tool would get them.
void expect_a_node(std::shared_ptr<FrameLink> link) {
  NodeClient client(kLinuxNode, LinkPump(std::move(link)));
  auto state = client.await_heartbeat(10'000'000);
  if (state == canopen::NmtState::boot_up) state = client.await_heartbeat(10'000'000);
  EXPECT_EQ(state, canopen::NmtState::pre_operational);
  EXPECT_EQ(number(client.read({0x1018, 2}, 4, "product code")), 0x564F'4C43U);
  EXPECT_EQ(diagnose(client).at("network_state"), "PRE-OPERATIONAL, waits to be started");
}

// --- frame pipe

TEST(PipeLink, NodeIsReadOverIt) {
  const TemporaryFolder folder;
  const PipeNode node(folder.path());
  expect_a_node(open_frame_link("pipe:" + folder.path().string()));
}

TEST(PipeLink, HostMayComeFirst) {
  const TemporaryFolder folder;
  std::unique_ptr<PipeNode> node;
  PipeLink link(folder.path(), [&](bool gone) {
    EXPECT_FALSE(gone);
    if (!node) node = std::make_unique<PipeNode>(folder.path());
  });
  link.wait(0);
  EXPECT_TRUE(node);
}

TEST(PipeLink, EveryTurnIsAMillisecondOfTheNodeWhoeverNeedsLonger) {
  const TemporaryFolder folder;
  const PipeNode node(folder.path());
  PipeLink link(folder.path());
  ASSERT_TRUE(link.turn_by_turn());
  std::vector<std::uint64_t> heartbeats;
  hal::CanFrame frame;
  for (int i = 0; i < 1000; ++i) {
    link.wait(123'456);
    while (link.receive(frame)) {
      if (frame.id == 0x700U + kLinuxNode) heartbeats.push_back(link.now_us());
    }
  }
  EXPECT_EQ(link.now_us(), 1'000'000U);
  ASSERT_GT(heartbeats.size(), 3U);  // a boot-up, then 1017h: 100 ms
  for (std::size_t i = 2; i < heartbeats.size(); ++i)
    EXPECT_EQ(heartbeats[i] - heartbeats[i - 1], 100'000U);
}

TEST(PipeLink, SameTurnsSameAnswers) {
  const auto talk = [] {
    const TemporaryFolder folder;
    const PipeNode node(folder.path());
    PipeLink link(folder.path());
    std::string said;
    for (int i = 0; i < 500; ++i) {
      if (i % 7 == 0)
        static_cast<void>(link.send({0x600 + kLinuxNode, 8, {0x40, 0x18, 0x10, 2, 0, 0, 0, 0}}));
      link.wait(0);
      for (hal::CanFrame f; link.receive(f);)
        said += fmt::format("{}: {:03X} {:02X}\n", i, f.id, fmt::join(f.data, " "));
    }
    return said;
  };
  const std::string first = talk();
  EXPECT_THAT(first, HasSubstr("5A0 43 18 10 02 43 4C 4F 56"));
  EXPECT_EQ(talk(), first);
}

TEST(PipeLink, NodeThatIsGoneIsNamed) {
  const TemporaryFolder folder;
  auto node = std::make_unique<PipeNode>(folder.path());
  PipeLink link(folder.path());
  link.wait(0);
  node.reset();
  EXPECT_EQ(sim::complaint_of([&] {
              link.wait(0);
              link.wait(0);
            }),
            "pipe:" + folder.path().string() + ": the node at the other end is gone");
}

TEST(PipeLink, WatchKnowsBetterWhyTheNodeIsGone) {
  const TemporaryFolder folder;
  auto node = std::make_unique<PipeNode>(folder.path());
  PipeLink link(folder.path(), [](bool gone) {
    if (gone) throw UserError("pulled the plug");
  });
  node.reset();
  EXPECT_EQ(sim::complaint_of([&] {
              link.wait(0);
              link.wait(0);
            }),
            "pulled the plug");
}

// Ending the program need not wait for a slow answer.
TEST(PipeLink, WatchIsAskedAtEveryTurn) {
  const TemporaryFolder folder;
  const PipeNode node(folder.path());
  int asked = 0;
  PipeLink link(folder.path(), [&asked](bool /*gone*/) { ++asked; });
  for (int turn = 1; turn <= 100; ++turn) {
    link.wait(0);
    ASSERT_GE(asked, turn);
  }
}

TEST(PipeLink, NonsenseFromTheNodeIsRefused) {
  const TemporaryFolder folder;
  make_frame_pipes(folder.path());
  const Descriptor to_node(
      ::open((folder.path() / "to_node").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  PipeLink link(folder.path());
  const Descriptor from_node(
      ::open((folder.path() / "from_node").c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  const std::string nonsense(hal::kPipeRecordBytes, 'x');
  ASSERT_EQ(::write(from_node.number(), nonsense.data(), nonsense.size()),
            static_cast<ssize_t>(nonsense.size()));
  EXPECT_THAT(sim::complaint_of([&] { link.wait(0); }), HasSubstr("no record of a frame pipe"));
}

// A turn that comes in two pieces, torn in the middle of a record.
TEST(PipeLink, TornRecordsArePutTogether) {
  const TemporaryFolder folder;
  make_frame_pipes(folder.path());
  const Descriptor to_node(
      ::open((folder.path() / "to_node").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  Descriptor from_node;
  std::string rest;
  PipeLink link(folder.path(), [&](bool) {
    EXPECT_EQ(::write(from_node.number(), rest.data(), rest.size()),
              static_cast<ssize_t>(rest.size()));
    rest.clear();
  });
  from_node =
      Descriptor(::open((folder.path() / "from_node").c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  const hal::CanFrame sent{0x5A0, 3, {1, 2, 3}};
  const hal::PipeBytes frame = hal::pipe_frame(sent);
  const hal::PipeBytes end = hal::pipe_end_of_turn(0);
  rest.assign(frame.begin(), frame.end());
  rest.append(end.begin(), end.end());
  ASSERT_EQ(::write(from_node.number(), rest.data(), 5), 5);
  rest.erase(0, 5);
  link.wait(0);
  hal::CanFrame received;
  ASSERT_TRUE(link.receive(received));
  EXPECT_EQ(received, sent);
  EXPECT_FALSE(link.receive(received));
}

TEST(PipeLink, QuitEndsTheNode) {
  const TemporaryFolder folder;
  hal::NodePipe pipe;
  ASSERT_TRUE(pipe.open(folder.path().c_str()).ok());
  PipeLink link(folder.path());
  link.quit();
  EXPECT_FALSE(pipe.begin_turn(10'000'000));
  EXPECT_TRUE(pipe.ended());
}

TEST(PipeLink, PlacesThatCannotHoldPipesAreNamed) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal_of("pipe:/no/such/folder"), HasSubstr("/no/such/folder: there is no such"));
  write_whole_file(folder.path() / "to_node", "a file");
  EXPECT_THAT(refusal_of("pipe:" + folder.path().string()), HasSubstr("to_node is no pipe"));
  EXPECT_THAT(refusal_of("pipe:"), HasSubstr("needs a folder"));
}

TEST(NodePipe, PlacesThatCannotHoldPipesHaveAReason) {
  const TemporaryFolder folder;
  hal::NodePipe pipe;
  EXPECT_EQ(pipe.open("/no/such/folder").result, hal::OpenResult::no_such_folder);
  write_whole_file(folder.path() / "to_node", "a file");
  EXPECT_EQ(pipe.open(folder.path().c_str()).result, hal::OpenResult::not_a_pipe);
}

// --- SLCAN

TEST(SlcanLink, NodeIsReadOverIt) {
  SlcanNode node;
  expect_a_node(open_frame_link("slcan:" + node.device_name()));
}

TEST(SlcanLink, OpensAtOneMegabitAndCloses) {
  SlcanNode node;
  {
    SlcanLink link(node.device_name());
    link.wait(0);
  }
  node.stop();
  hal::CanFrame frame;
  EXPECT_FALSE(node.receive(frame));
  EXPECT_THAT(node.heard(), testing::StartsWith("\r\r\rC\rV\rS8\rO\r"));
  EXPECT_THAT(node.heard(), testing::EndsWith("C\r"));
  EXPECT_FALSE(node.channel_open());
}

// Somebody left the channel open and half a line behind.
TEST(SlcanLink, TakesOverWhatOthersLeft) {
  SlcanNode node;
  {
    const SerialDevice other(node.device_name());
    EXPECT_EQ(SerialDevice(node.device_name()).write("O\rt12"), 5U);
  }
  expect_a_node(open_frame_link("slcan:" + node.device_name()));
}

TEST(SlcanLink, NoMoreThanTheAdapterHoldsIsUnderWay) {
  SlcanNode node;
  SlcanLink link(node.device_name());
  node.stop();
  const hal::CanFrame frame{0x123, 0, {}};
  for (std::size_t i = 0; i < SlcanLink::kMostUnanswered; ++i)
    EXPECT_TRUE(link.send(frame));
  EXPECT_FALSE(link.send(frame));
  hal::CanFrame received;
  ASSERT_TRUE(node.receive(received));  // and acknowledged
  ASSERT_TRUE(node.receive(received));
  link.wait(1'000'000);
  EXPECT_TRUE(link.send(frame));
  EXPECT_TRUE(link.send(frame));
  EXPECT_FALSE(link.send(frame));
}

TEST(SlcanLink, UnixSocketIsALineToo) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "uart";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(&address.sun_path[0], sizeof address.sun_path - 1);
  const Descriptor listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ASSERT_EQ(::bind(listener.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address),
            0);
  ASSERT_EQ(::listen(listener.number(), 1), 0);
  SerialDevice device(path);
  const Descriptor other(::accept(listener.number(), nullptr, nullptr));
  EXPECT_EQ(device.write("V\r"), 2U);
  std::array<char, 8> heard{};
  EXPECT_EQ(::read(other.number(), heard.data(), heard.size()), 2);
}

TEST(SlcanLink, LineThatIsHungUpIsNamed) {
  auto node = std::make_unique<SlcanNode>();
  const std::string name = node->device_name();
  SlcanLink link(name);
  node.reset();
  hal::CanFrame frame;
  EXPECT_EQ(sim::complaint_of([&] {
              for (int i = 0; i < 1000; ++i)
                static_cast<void>(link.receive(frame));
            }),
            name + ": the other end is gone");
}

TEST(SlcanLink, WhatIsNoLineIsNamed) {
  EXPECT_EQ(refusal_of("slcan:/dev/no-such-line"), "/dev/no-such-line: No such file or directory");
  EXPECT_EQ(refusal_of("slcan:/dev/null"), "/dev/null: is neither a serial line nor a socket");
  EXPECT_THAT(refusal_of("slcan:"), HasSubstr("needs a device"));
  const SlcanNode node;
  EXPECT_EQ(refusal_of("slcan:" + node.device_name() + "@31"),
            node.device_name() + ": there is no rate of 31 baud");
}

// --- bursts

// The other end: what waits at its interface, what its controller holds, and how far it has come.
struct SlowReceiver {
  int waiting = 0;
  int held = 0;
  std::uint64_t progress = 0;

  // Its controller takes in one frame and it comes 60 steps further at each call; it fetches what
  // its controller holds every 100 steps.
  std::uint64_t ask() {
    if (waiting > 0) {
      --waiting;
      ++held;
    }
    const std::uint64_t before = progress;
    progress += 60;
    if (before / 100 != progress / 100) held = 0;
    return progress;
  }
};

class LinkToSlowReceiver final : public FrameLink {
 public:
  explicit LinkToSlowReceiver(SlowReceiver& receiver) : receiver_(receiver) {}

  [[nodiscard]] bool send(const hal::CanFrame& /*frame*/) override {
    ++receiver_.waiting;
    return true;
  }
  [[nodiscard]] bool receive(hal::CanFrame& /*frame*/) override { return false; }
  void wait(std::uint32_t /*timeout_us*/) override {}
  [[nodiscard]] std::uint64_t now_us() const override { return 0; }
  [[nodiscard]] bool turn_by_turn() const override { return false; }

 private:
  SlowReceiver& receiver_;
};

// Wherever its controller takes in what waits: also if it does so all at once.
TEST(PacedLink, OtherEndNeverHasMoreThanABurst) {
  SlowReceiver receiver;
  PacedLink link(
      std::make_unique<LinkToSlowReceiver>(receiver), [&] { return receiver.ask(); }, 4, 100);
  for (int i = 0; i < 40; ++i) {
    EXPECT_TRUE(link.send({}));
    EXPECT_LE(receiver.waiting + receiver.held, 4);
  }
}

// QEMU tells how far its processor is only at the end of a slice: what it reports may be from
// before the frames were there, and then jumps past what it was to execute after that.
TEST(PacedLink, ProgressFromBeforeABurstDoesNotCountForIt) {
  constexpr std::uint64_t kSlice = 500;
  constexpr std::uint64_t kSpacing = 100;
  std::uint64_t executed = 0;
  std::uint64_t sent_at = 0;
  SlowReceiver unused;
  PacedLink link(
      std::make_unique<LinkToSlowReceiver>(unused),
      [&] {
        executed += 10;
        return executed / kSlice * kSlice;
      },
      1, kSpacing);
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(link.send({}));
    if (i > 0) {
      EXPECT_GE(executed - sent_at, kSpacing) << i;
    }
    executed += static_cast<std::uint64_t>(37 * i);  // somewhere in a slice
    sent_at = executed;
  }
}

}  // namespace
}  // namespace volcomp::host
