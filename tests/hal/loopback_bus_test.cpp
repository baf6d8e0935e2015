// The bus without faults: arbitration, time, queues, and that nothing is lost or invented.

#include "hal/loopback/loopback_bus.hpp"

#include <stdexcept>
#include <tuple>

#include "hal/loopback/frame_bits.hpp"
#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using hal::CanFrame;
using hal::FrameLength;
using hal::LoopbackBus;
using Ids = std::vector<unsigned>;
static_assert(hal::IsCanPort<LoopbackBus::Port>::value);

constexpr std::uint64_t kEmptyFrameNs = 47'000;  // 47 bits at 1 Mbit/s

void send_all(LoopbackBus& bus) {
  while (bus.step(bus.now_ns() + 1)) {
  }
}

std::vector<LoopbackBus::Port*> attach(LoopbackBus& bus, std::size_t count,
                                       std::size_t transmit_capacity) {
  std::vector<LoopbackBus::Port*> ports(count);
  for (auto& port : ports)
    port = &bus.attach("port", transmit_capacity);
  return ports;
}

TEST(LoopbackBus, LowestIdentifierGoesFirst) {
  LoopbackBus bus;
  auto& listener = bus.attach("listener");
  auto& a = bus.attach("a");
  auto& b = bus.attach("b");
  ASSERT_TRUE(a.send(frame(0x7FF)) && a.send(frame(0x000)));
  ASSERT_TRUE(b.send(frame(0x080)) && b.send(frame(0x7FE)));
  send_all(bus);
  // 000h waits behind 7FFh of the same port.
  EXPECT_EQ(received_ids(listener), (Ids{0x080, 0x7FE, 0x7FF, 0x000}));
}

TEST(LoopbackBus, OfEqualIdentifiersTheLowerPortNumberGoesFirst) {
  LoopbackBus bus;
  auto& first = bus.attach("first");
  auto& second = bus.attach("second");
  auto& listener = bus.attach("listener");
  ASSERT_TRUE(second.send(frame(0x100, {2})));
  ASSERT_TRUE(first.send(frame(0x100, {1})));
  send_all(bus);
  EXPECT_EQ(receive_all(listener), (std::vector<CanFrame>{frame(0x100, {1}), frame(0x100, {2})}));
}

TEST(LoopbackBus, SenderDoesNotHearItself) {
  LoopbackBus bus;
  auto& a = bus.attach("a");
  auto& b = bus.attach("b");
  ASSERT_TRUE(a.send(frame(1)));
  send_all(bus);
  EXPECT_EQ(a.waiting(), 0U);
  EXPECT_EQ(b.waiting(), 1U);
}

TEST(LoopbackBus, FrameTakesItsBitsAndIdleTimeRunsToTheEnd) {
  LoopbackBus bus;
  auto& a = bus.attach("a");
  ASSERT_TRUE(a.send(frame(1)));
  EXPECT_TRUE(bus.step(1'000'000));
  EXPECT_EQ(bus.now_ns(), kEmptyFrameNs);
  EXPECT_FALSE(bus.step(1'000'000));
  EXPECT_EQ(bus.now_ns(), 1'000'000U);
  EXPECT_EQ(bus.busy_ns(), kEmptyFrameNs);
}

TEST(LoopbackBus, FrameMayEndAfterTheLimitButNotStartThere) {
  LoopbackBus bus;
  auto& a = bus.attach("a");
  ASSERT_TRUE(a.send(frame(1)));
  ASSERT_TRUE(a.send(frame(2)));
  EXPECT_FALSE(bus.step(0));
  EXPECT_TRUE(bus.step(1));
  EXPECT_EQ(bus.now_ns(), kEmptyFrameNs);
  EXPECT_FALSE(bus.step(kEmptyFrameNs));
  EXPECT_EQ(bus.now_ns(), kEmptyFrameNs);
  EXPECT_EQ(a.unsent(), 1U);
}

TEST(LoopbackBus, TimeNeverGoesBack) {
  LoopbackBus bus;
  EXPECT_FALSE(bus.step(1000));
  EXPECT_FALSE(bus.step(10));
  EXPECT_EQ(bus.now_ns(), 1000U);
}

TEST(LoopbackBus, DurationFollowsBitRateAndLengthModel) {
  const CanFrame zeros = frame(0x000);  // 47 bits and 6 stuff bits, at most 8
  EXPECT_EQ(LoopbackBus(500'000).duration_ns(zeros), 47U * 2000U);
  EXPECT_EQ(LoopbackBus(800'000).duration_ns(zeros), 47U * 1250U);
  EXPECT_EQ(LoopbackBus(1'000'000, FrameLength::exact).duration_ns(zeros), 53'000U);
  EXPECT_EQ(LoopbackBus(1'000'000, FrameLength::worst_case).duration_ns(zeros), 55'000U);
  EXPECT_THROW(LoopbackBus(0), std::invalid_argument);
}

TEST(LoopbackBus, TransmitQueueRefusesWhatDoesNotFit) {
  LoopbackBus bus;
  auto& a = bus.attach("a", 2);
  EXPECT_TRUE(a.send(frame(1)));
  EXPECT_TRUE(a.send(frame(2)));
  EXPECT_FALSE(a.send(frame(3)));
  EXPECT_EQ(a.counters().refused, 1U);
  EXPECT_TRUE(bus.step(1));
  EXPECT_TRUE(a.send(frame(4)));
}

TEST(LoopbackBus, FullReceiveQueueDropsTheNewestAndCounts) {
  LoopbackBus bus;
  auto& a = bus.attach("a", 300);
  auto& b = bus.attach("b");
  for (std::uint16_t id = 0; id < 300; ++id)
    ASSERT_TRUE(a.send(frame(id)));
  send_all(bus);
  EXPECT_EQ(b.counters().received, 256U);
  EXPECT_EQ(b.counters().overrun, 44U);
  const Ids ids = received_ids(b);
  ASSERT_EQ(ids.size(), 256U);
  EXPECT_EQ(ids.back(), 255U);
}

TEST(LoopbackBus, FirstFrameIsSeenBeforeItIsTakenOrSkipped) {
  LoopbackBus bus;
  LoopbackBus::Port& sender = bus.attach("sender");
  LoopbackBus::Port& receiver = bus.attach("receiver");
  EXPECT_EQ(receiver.first(), nullptr);
  // More than once round the queue, with one to three frames in it.
  std::uint16_t sent = 0;
  std::uint16_t next = 0;
  for (int round = 0; round < 300; ++round) {
    for (int n = 0; n <= round % 3; ++n)
      ASSERT_TRUE(sender.send({sent++, 0, {}}));
    send_all(bus);
    while (receiver.waiting() > static_cast<std::size_t>(round % 2)) {
      ASSERT_NE(receiver.first(), nullptr);
      EXPECT_EQ(receiver.first()->id, next++);
      CanFrame frame;
      if (round % 4 < 2) {
        receiver.skip();
      } else {
        ASSERT_TRUE(receiver.receive(frame));
      }
    }
  }
  EXPECT_EQ(next, sent - receiver.waiting());
  EXPECT_EQ(receiver.counters().received, sent);
}

TEST(LoopbackBus, AFilterKeepsFramesOutWhileNoneWaits) {
  LoopbackBus bus;
  LoopbackBus::Port& sender = bus.attach("sender");
  LoopbackBus::Port& receiver = bus.attach("receiver");
  receiver.set_filter([](const CanFrame& f) { return f.id >= 0x100; });
  for (const std::uint16_t id : std::initializer_list<std::uint16_t>{0x080, 0x081, 0x180})
    ASSERT_TRUE(sender.send(frame(id)));
  send_all(bus);
  ASSERT_TRUE(sender.send(frame(0x082)));
  send_all(bus);
  EXPECT_EQ(received_ids(receiver), (Ids{0x180, 0x082})) << "behind one that waits";
  EXPECT_EQ(receiver.counters().received, 4U);
  receiver.set_filter({});
  ASSERT_TRUE(sender.send(frame(0x083)));
  send_all(bus);
  EXPECT_EQ(received_ids(receiver), (Ids{0x083}));
}

TEST(LoopbackBus, ImpossibleFrameIsAMistakeOfTheCaller) {
  LoopbackBus bus;
  auto& a = bus.attach("a");
  CanFrame nine_bytes = frame(1);
  nine_bytes.size = 9;
  EXPECT_THROW(static_cast<void>(a.send(frame(0x800))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(a.send(nine_bytes)), std::invalid_argument);
}

TEST(LoopbackBus, DisconnectedPortNeitherSendsNorReceivesAndForgets) {
  LoopbackBus bus;
  auto& a = bus.attach("a");
  auto& b = bus.attach("b");
  ASSERT_TRUE(a.send(frame(1)));
  ASSERT_TRUE(b.send(frame(2)));
  ASSERT_TRUE(bus.step(1));
  ASSERT_EQ(b.waiting(), 1U);
  b.connect(false);
  EXPECT_EQ(b.waiting(), 0U);
  EXPECT_EQ(b.unsent(), 0U);
  EXPECT_FALSE(b.send(frame(3)));
  ASSERT_TRUE(a.send(frame(4)));
  send_all(bus);
  b.connect(true);
  ASSERT_TRUE(a.send(frame(5)));
  send_all(bus);
  EXPECT_EQ(received_ids(b), (Ids{5}));
  EXPECT_EQ(received_ids(a), (Ids{}));
}

TEST(LoopbackBus, ConnectingTwiceForgetsNothing) {
  LoopbackBus bus;
  auto& a = bus.attach("a");
  auto& b = bus.attach("b");
  ASSERT_TRUE(a.send(frame(1)));
  send_all(bus);
  b.connect(true);
  EXPECT_EQ(received_ids(b), (Ids{1}));
}

TEST(LoopbackBus, ReferencesStayValidWhenPortsAreAdded) {
  LoopbackBus bus;
  auto& first = bus.attach("first");
  for (int i = 0; i < 100; ++i)
    bus.attach("port " + std::to_string(i));
  EXPECT_EQ(first.name(), "first");
  EXPECT_EQ(first.number(), 0U);
  EXPECT_EQ(bus.attach("last").number(), 101U);
}

using Trace = std::vector<std::tuple<std::uint64_t, std::size_t, unsigned, unsigned>>;

struct Traffic {
  Trace trace;
  std::uint64_t durations_ns = 0;
  std::uint64_t accepted = 0;
};

// Bursts of random frames from random ports, everything received at once.
Traffic random_traffic(LoopbackBus& bus, Random& random,
                       const std::vector<LoopbackBus::Port*>& ports) {
  Traffic result;
  bus.set_observer([&](std::uint64_t time_ns, const CanFrame& f, const LoopbackBus::Port& from) {
    result.trace.emplace_back(time_ns, from.number(), f.id, f.size);
    result.durations_ns += bus.duration_ns(f);
  });
  for (int i = 0; i < 3000; ++i) {
    auto& port = *ports[static_cast<std::size_t>(
        random.integer(0, static_cast<std::int64_t>(ports.size()) - 1))];
    result.accepted += port.send(random_frame(random)) ? 1U : 0U;
    if (random.chance(0.7)) bus.step(bus.now_ns() + 200'000);
    for (auto* p : ports)
      receive_all(*p);
  }
  while (bus.step(bus.now_ns() + 1)) {
    for (auto* p : ports)
      receive_all(*p);
  }
  return result;
}

TEST(LoopbackBus, SameCallsGiveTheSameTrace) {
  const auto run = [] {
    LoopbackBus bus(1'000'000, FrameLength::exact);
    Random random;
    return random_traffic(bus, random, {&bus.attach("a"), &bus.attach("b"), &bus.attach("c")});
  };
  const Traffic first = run();
  EXPECT_EQ(first.trace, run().trace);
  EXPECT_FALSE(first.trace.empty());
}

TEST(LoopbackBus, BusyTimeIsTheSumOfAllFrames) {
  LoopbackBus bus(250'000, FrameLength::exact);
  Random random(1);
  SCOPED_TRACE(random.trace());
  const Traffic traffic = random_traffic(bus, random, {&bus.attach("a"), &bus.attach("b")});
  EXPECT_EQ(bus.busy_ns(), traffic.durations_ns);
  EXPECT_EQ(bus.frames(), traffic.trace.size());
  EXPECT_LE(bus.busy_ns(), bus.now_ns());
}

TEST(LoopbackBus, EveryFrameReachesEveryOtherConnectedPortOnce) {
  LoopbackBus bus;
  Random random(2);
  SCOPED_TRACE(random.trace());
  const std::vector<LoopbackBus::Port*> ports = attach(bus, 6, 64);
  bus.attach("unplugged").connect(false);
  const Traffic traffic = random_traffic(bus, random, ports);
  std::uint64_t received = 0;
  for (const auto* port : ports)
    received += port->counters().received;
  EXPECT_EQ(bus.frames(), traffic.accepted);
  EXPECT_EQ(received, traffic.accepted * 5);
}

// Whatever waits, no port's next frame may have a lower identifier than the one that was sent.
TEST(LoopbackBus, NoFrameOvertakesALowerIdentifier) {
  LoopbackBus bus;
  Random random(3);
  SCOPED_TRACE(random.trace());
  const std::vector<LoopbackBus::Port*> ports = attach(bus, 8, 1);
  unsigned sent_id = 0;
  bus.set_observer(
      [&](std::uint64_t, const CanFrame& f, const LoopbackBus::Port&) { sent_id = f.id; });
  std::vector<unsigned> waiting(ports.size());
  for (int i = 0; i < 5000; ++i) {
    for (std::size_t p = 0; p < ports.size(); ++p) {
      const CanFrame f = random_frame(random);
      if (random.chance(0.5) && ports[p]->send(f)) waiting[p] = f.id;
    }
    unsigned lowest = hal::kMaxCanId + 1U;
    for (std::size_t p = 0; p < ports.size(); ++p) {
      if (ports[p]->unsent() > 0) lowest = std::min(lowest, waiting[p]);
    }
    if (!bus.step(bus.now_ns() + 1)) continue;
    ASSERT_EQ(sent_id, lowest);
  }
}

}  // namespace
}  // namespace volcomp::test
