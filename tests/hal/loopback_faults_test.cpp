// Faults happen as requested, and only there.

#include "hal/loopback/loopback_bus.hpp"

#include <map>

#include "tests/hal/support.hpp"

namespace volcomp::test {
namespace {

using hal::CanFrame;
using hal::LoopbackBus;
using Fate = LoopbackBus::Fate;
using Ids = std::vector<unsigned>;

constexpr std::uint64_t kShortestFrameNs = 47'000;  // 47 bits at 1 Mbit/s
constexpr std::uint64_t kLater = 1'000'000'000;

class LoopbackFaults : public ::testing::Test {
 protected:
  // Only frames with this identifier on their way to b.
  void at_b(unsigned id, const Fate& fate) {
    bus_.set_fault_hook([this, id, fate](const CanFrame& f, const auto&, const auto& receiver) {
      return f.id == id && &receiver == &b_ ? fate : Fate{};
    });
  }
  void send_and_run(const Ids& ids) {
    for (const unsigned id : ids)
      ASSERT_TRUE(sender_.send(frame(static_cast<std::uint16_t>(id))));
    while (bus_.step(kLater)) {
    }
  }

  LoopbackBus bus_;
  LoopbackBus::Port& sender_ = bus_.attach("sender");
  LoopbackBus::Port& a_ = bus_.attach("a");
  LoopbackBus::Port& b_ = bus_.attach("b");
};

Fate lost() { return {true, false, 0}; }
Fate twice(std::uint64_t delay_ns = 0) { return {false, true, delay_ns}; }
Fate delayed(std::uint64_t delay_ns) { return {false, false, delay_ns}; }

TEST_F(LoopbackFaults, LostForOneReceiverOnly) {
  at_b(2, lost());
  send_and_run({1, 2, 3});
  EXPECT_EQ(received_ids(a_), (Ids{1, 2, 3}));
  EXPECT_EQ(received_ids(b_), (Ids{1, 3}));
}

TEST_F(LoopbackFaults, ReceivedTwiceByOneReceiverOnly) {
  at_b(2, twice());
  send_and_run({1, 2, 3});
  EXPECT_EQ(received_ids(a_), (Ids{1, 2, 3}));
  EXPECT_EQ(received_ids(b_), (Ids{1, 2, 2, 3}));
}

TEST_F(LoopbackFaults, DelayedFrameIsOvertaken) {
  at_b(1, delayed(2 * kShortestFrameNs + 1));
  send_and_run({1, 2, 3, 4});
  EXPECT_EQ(received_ids(a_), (Ids{1, 2, 3, 4}));
  EXPECT_EQ(received_ids(b_), (Ids{2, 3, 1, 4}));
}

TEST_F(LoopbackFaults, DelayedFrameComesBeforeTheOneThatEndsAtThatMoment) {
  at_b(1, delayed(kShortestFrameNs));
  send_and_run({1, 2});
  EXPECT_EQ(received_ids(b_), (Ids{1, 2}));
}

TEST_F(LoopbackFaults, IdleBusStopsAtTheMomentOfTheDelayedFrame) {
  at_b(1, delayed(123'456));
  ASSERT_TRUE(sender_.send(frame(1)));
  ASSERT_TRUE(bus_.step(kLater));
  EXPECT_EQ(b_.waiting(), 0U);
  EXPECT_FALSE(bus_.step(kShortestFrameNs + 123'455));  // not due yet
  EXPECT_TRUE(bus_.step(kLater));
  EXPECT_EQ(bus_.now_ns(), kShortestFrameNs + 123'456);
  EXPECT_EQ(b_.waiting(), 1U);
  EXPECT_FALSE(bus_.step(kLater));
  EXPECT_EQ(bus_.busy_ns(), kShortestFrameNs);
}

TEST_F(LoopbackFaults, BothCopiesAreDelayed) {
  at_b(1, twice(kShortestFrameNs + 1));
  send_and_run({1, 2, 3});
  EXPECT_EQ(received_ids(b_), (Ids{2, 1, 1, 3}));
}

TEST_F(LoopbackFaults, DisconnectingDropsWhatIsOnItsWay) {
  at_b(1, delayed(500'000));
  ASSERT_TRUE(sender_.send(frame(1)));
  ASSERT_TRUE(bus_.step(kLater));
  b_.connect(false);
  b_.connect(true);
  EXPECT_FALSE(bus_.step(kLater));
  EXPECT_EQ(b_.waiting(), 0U);
}

TEST_F(LoopbackFaults, DisconnectingDropsNothingOfTheOthers) {
  bus_.set_fault_hook([](const auto&...) { return delayed(500'000); });
  ASSERT_TRUE(sender_.send(frame(1)));
  ASSERT_TRUE(bus_.step(kLater));
  b_.connect(false);
  while (bus_.step(kLater)) {
  }
  EXPECT_EQ(received_ids(a_), (Ids{1}));
  EXPECT_EQ(b_.counters().received, 0U);
}

// The hook may pull the plug itself.
TEST_F(LoopbackFaults, WhoIsUnpluggedByTheFaultHearsNothing) {
  bus_.set_fault_hook([this](const auto&, const auto&, const auto& receiver) {
    if (&receiver == &b_) b_.connect(false);
    return twice();
  });
  send_and_run({1});
  EXPECT_EQ(received_ids(a_), (Ids{1, 1}));
  EXPECT_TRUE(received_ids(b_).empty());
}

TEST_F(LoopbackFaults, FullBusRefusesNewFramesAndSendsQueuedOnes) {
  ASSERT_TRUE(sender_.send(frame(1)));
  bus_.set_full(true);
  EXPECT_FALSE(sender_.send(frame(2)));
  EXPECT_FALSE(a_.send(frame(3)));
  EXPECT_EQ(a_.counters().refused, 1U);
  EXPECT_TRUE(bus_.step(kLater));
  bus_.set_full(false);
  EXPECT_TRUE(sender_.send(frame(4)));
  while (bus_.step(kLater)) {
  }
  EXPECT_EQ(received_ids(b_), (Ids{1, 4}));
}

TEST_F(LoopbackFaults, EveryFrameIsObservedOnceWhateverItsFate) {
  Ids observed;
  bus_.set_observer(
      [&](std::uint64_t, const CanFrame& f, const auto&) { observed.push_back(f.id); });
  bus_.set_fault_hook([](const CanFrame& f, const auto&, const auto&) {
    return f.id == 1 ? lost() : twice(std::uint64_t{1000} * f.id);
  });
  send_and_run({1, 2, 3});
  EXPECT_EQ(observed, (Ids{1, 2, 3}));
  EXPECT_EQ(bus_.frames(), 3U);
}

TEST_F(LoopbackFaults, HookIsAskedOncePerFrameAndOtherConnectedPort) {
  bus_.attach("unplugged").connect(false);
  std::map<std::string, int> asked;
  bus_.set_fault_hook([&](const CanFrame&, const auto& from, const auto& to) {
    ++asked[from.name() + " " + to.name()];
    return Fate{};
  });
  send_and_run({1, 2});
  EXPECT_EQ(asked, (std::map<std::string, int>{{"sender a", 2}, {"sender b", 2}}));
}

// What each receiver should get follows from the fates alone: its copies in order of their time.
TEST_F(LoopbackFaults, RandomFatesArriveInTheOrderOfTheirTimes) {
  Random random;
  SCOPED_TRACE(random.trace());
  std::map<const LoopbackBus::Port*, std::multimap<std::uint64_t, unsigned>> expected;
  bus_.set_fault_hook([&](const CanFrame& f, const auto&, const LoopbackBus::Port& to) {
    const auto frame_times = static_cast<std::uint64_t>(random.integer(0, 4));
    const Fate fate{random.chance(0.2), random.chance(0.2),
                    random.chance(0.5) ? frame_times * kShortestFrameNs : 0U};
    for (int copy = fate.twice ? 0 : 1; copy < 2 && !fate.lost; ++copy)
      expected[&to].emplace(bus_.now_ns() + fate.delay_ns, f.id);
    return fate;
  });
  std::map<const LoopbackBus::Port*, Ids> received;
  for (unsigned i = 0; i < 4000; ++i) {
    ASSERT_TRUE(sender_.send(frame(static_cast<std::uint16_t>(i % 2048))));
    bus_.step(bus_.now_ns() + 1);
    if (random.chance(0.2)) bus_.step(bus_.now_ns() + kShortestFrameNs);
    for (auto* port : {&a_, &b_}) {
      const Ids ids = received_ids(*port);
      received[port].insert(received[port].end(), ids.begin(), ids.end());
    }
  }
  while (bus_.step(kLater)) {
  }
  for (auto* port : {&a_, &b_}) {
    const Ids rest = received_ids(*port);
    received[port].insert(received[port].end(), rest.begin(), rest.end());
    Ids wanted;
    for (const auto& [time_ns, id] : expected[port])
      wanted.push_back(id);
    EXPECT_EQ(received[port], wanted) << port->name();
  }
}

}  // namespace
}  // namespace volcomp::test
