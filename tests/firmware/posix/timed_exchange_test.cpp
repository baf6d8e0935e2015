// One turn of volcomp-node around a port that gives back what has been on the bus, and one that
// does not.

#include "firmware/posix/timed_exchange.hpp"

#include <deque>
#include <vector>

#include "tests/firmware/node/forwarding_bench.hpp"

namespace volcomp::posix {
namespace {

using node::ForwardingBench;
using node::kNodeAxes;

constexpr std::array<std::uint16_t, 3> kTargets{0x301, 0x302, 0x303};

// --- which targets are under way

TEST(SendingProof, IsUnderWayUntilItComesBack) {
  SendingProof proof;
  proof.handed_over(0, 1000);
  EXPECT_EQ(proof.unconfirmed(), 0U) << "nothing has ever come back: nothing waits for it";
  proof.came_back(0, 1100);
  proof.handed_over(0, 2000);
  proof.handed_over(2, 2000);
  EXPECT_EQ(proof.unconfirmed(), 0b101U);
  proof.came_back(2, 2100);
  EXPECT_EQ(proof.unconfirmed(), 0b001U);
  proof.forget();
  EXPECT_EQ(proof.unconfirmed(), 0U);
}

TEST(SendingProof, AFrameThatNeverComesBackIsForgottenInTheEnd) {
  SendingProof proof;
  proof.handed_over(1, 0);
  proof.came_back(1, 100);
  proof.handed_over(1, 1000);
  EXPECT_FALSE(proof.finds_no_proof(1000 + SendingProof::kPatience_us - 1));
  EXPECT_EQ(proof.unconfirmed(), 0b10U);
  EXPECT_FALSE(proof.finds_no_proof(1000 + SendingProof::kPatience_us)) << "others have come back";
  EXPECT_EQ(proof.unconfirmed(), 0U);
}

TEST(SendingProof, APortThatGivesNothingBackIsToldOnce) {
  SendingProof proof;
  int told = 0;
  for (std::uint64_t now_us = 0; now_us < 5'000'000; now_us += 2000) {
    proof.handed_over(0, now_us);
    told += proof.finds_no_proof(now_us) ? 1 : 0;
    EXPECT_EQ(proof.unconfirmed(), 0U);
  }
  EXPECT_EQ(told, 1);
}

// --- turns

struct TestClock {
  std::uint64_t now = 0;
  [[nodiscard]] std::uint64_t now_us() const { return now; }
};

struct TestPort {
  struct Entry {
    hal::CanFrame frame;
    bool own = false;
  };
  std::deque<Entry> waiting;
  std::vector<hal::CanFrame> sent;
  bool of_last = false;

  bool receive(hal::CanFrame& frame) {
    if (waiting.empty()) return false;
    frame = waiting.front().frame;
    of_last = waiting.front().own;
    waiting.pop_front();
    return true;
  }
  bool send(const hal::CanFrame& frame) {
    sent.push_back(frame);
    return true;
  }
  [[nodiscard]] bool own() const { return of_last; }
  [[nodiscard]] static std::uint32_t age_us() { return 0; }
};

// Three drives that follow forwarded targets.
class TimedTurns : public testing::Test {
 protected:
  void SetUp() override {
    bus.bring_up();
    bus.enable(true);
    bus.cycles(500);
    clock.now = bus.bench.now_us;
  }

  void turn() {
    clock.now += 10;
    exchange.turn(*bus.bench.node, port);
  }
  hal::CanFrame sync() {
    counter = static_cast<std::uint8_t>(node().objects().sync_counter % 240 + 1);
    return {canopen::kSync, 1, {counter}};
  }
  // A cycle in turns of its own; what the drives get is in port.sent.
  void cycle() {
    clock.now += 1000;
    port.sent.clear();
    port.waiting.push_back({sync()});
    for (unsigned axis = 0; axis < 3; ++axis) {
      hal::CanFrame status = node::bench_frame(0x181U + axis, 7);
      store_le(status.data.data(), 4, static_cast<std::uint32_t>(target));
      status.data[4] = 0x27;
      status.data[5] = 0x01;
      status.data[6] = 8;
      hal::CanFrame command = node::bench_frame(0x201U + axis, 6);
      command.data[0] = 0x0F;
      store_le(&command.data[2], 4, static_cast<std::uint32_t>(target));
      port.waiting.push_back({status});
      port.waiting.push_back({command});
    }
    turn();
    clock.now += 1000;
  }
  void give_back(std::uint16_t id) {
    port.waiting.push_back({node::bench_frame(id, 4), true});
    turn();
  }
  [[nodiscard]] int targets_of(std::uint16_t id) const {
    int count = 0;
    for (const hal::CanFrame& frame : port.sent)
      count += frame.id == id ? 1 : 0;
    return count;
  }
  [[nodiscard]] node::Node& node() const { return *bus.bench.node; }

  ForwardingBench bus;
  TestClock clock;
  TestPort port;
  TimedExchange<TestPort, TestClock> exchange{clock};
  std::int32_t target = -100'000'000;
  std::uint8_t counter = 0;
};

TEST_F(TimedTurns, TheAxisOfAFrameIsThatOfItsTarget) {
  EXPECT_EQ(forwarded_axis(node(), 0x301), 0U);
  EXPECT_EQ(forwarded_axis(node(), 0x303), 2U);
  EXPECT_EQ(forwarded_axis(node(), 0x304), std::size_t{kNodeAxes}) << "no drive";
  EXPECT_EQ(forwarded_axis(node(), 0x1A0), std::size_t{kNodeAxes}) << "the status of the node";
}

TEST_F(TimedTurns, TheNextTargetOfAnAxisWaitsForTheLastOne) {
  cycle();
  ASSERT_EQ(targets_of(0x301), 1);
  for (const std::uint16_t id : kTargets)
    give_back(id);
  cycle();
  give_back(0x302);
  give_back(0x303);
  cycle();
  EXPECT_EQ(targets_of(0x301), 0);
  EXPECT_EQ(targets_of(0x302), 1);
  EXPECT_EQ(node().objects().forwarded_late, 1U);
  give_back(0x301);
  EXPECT_EQ(targets_of(0x301), 1) << "it has come back: the one that waits leaves";
}

TEST_F(TimedTurns, WhatComesBackIsNotReceived) {
  const std::uint32_t cycles = node().objects().cycles;
  port.waiting.push_back({sync(), true});
  turn();
  clock.now += 2000;
  turn();
  EXPECT_EQ(node().objects().cycles, cycles);
}

// The order of the bus decides, not that of the turns: all of it may be read at once.
TEST_F(TimedTurns, OnTheBusBeforeSyncIsInTime) {
  cycle();
  for (const std::uint16_t id : kTargets)
    give_back(id);
  cycle();
  for (const std::uint16_t id : kTargets)
    port.waiting.push_back({node::bench_frame(id, 4), true});
  cycle();
  EXPECT_EQ(node().objects().forwarded_late, 0U);
  EXPECT_EQ(targets_of(0x301), 1);
}

TEST_F(TimedTurns, WithoutProofEveryTargetLeavesAndThatIsToldOnce) {
  int told = 0;
  for (int i = 0; i < 500; ++i) {
    cycle();
    EXPECT_EQ(targets_of(0x301), 1);
    told += exchange.take_no_proof() ? 1 : 0;
  }
  EXPECT_EQ(told, 1);
  EXPECT_EQ(node().objects().forwarded_late, 0U);
}

// An emergency goes before every target; one that the clock raises is only found after they left.
TEST_F(TimedTurns, TargetsDoNotWaitForTheWorkOfTheClock) {
  for (int i = 0; i < 30; ++i)
    cycle();
  clock.now += 61'000'000;  // 1016h: drives are lost after 60 s
  cycle();
  std::vector<std::uint16_t> ids;
  for (const hal::CanFrame& frame : port.sent)
    ids.push_back(frame.id);
  ASSERT_GE(ids.size(), 4U);
  EXPECT_TRUE(std::equal(kTargets.begin(), kTargets.end(), ids.begin()));
  EXPECT_NE(std::find(ids.begin(), ids.end(), canopen::kEmergency + 32), ids.end());
}

TEST_F(TimedTurns, WhatWasLostWithThePortIsForgotten) {
  cycle();
  for (const std::uint16_t id : kTargets)
    give_back(id);
  cycle();
  exchange.forget_sent(node());
  cycle();
  EXPECT_EQ(targets_of(0x301), 1);
}

}  // namespace
}  // namespace volcomp::posix
