// Forwarded targets through a port that tells which of them have been on the bus
// (Forwarding::unconfirmed()).

#include "tests/firmware/node/forwarding_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::ErrorCode;

constexpr std::uint8_t kAxisX = 1;  // source of emergencies
constexpr std::uint32_t kFirst = 1;
constexpr std::uint32_t kAll = 7;

class ProvenForwarding : public ::testing::Test {
 protected:
  void SetUp() override {
    bus.bring_up();
    bus.enable(true);
    bus.cycles(500);
    ASSERT_EQ(bus.frames(), 3);
    ASSERT_TRUE(bus.drive[0].follows());
    bus.bench.emergencies.clear();
  }
  void unconfirmed(std::uint32_t axes) const { bus.bench.node->unconfirmed(axes); }
  std::uint64_t not_forwarded() { return bus.bench.number(0x2603, 0); }
  std::uint64_t late() { return bus.bench.number(0x2604, 0); }

  ForwardingBench bus;
};

TEST_F(ProvenForwarding, ATargetWaitsUntilTheLastOneWasOnTheBus) {
  bus.cycle();
  unconfirmed(kFirst);
  bus.move(1000);
  const std::uint64_t missed = not_forwarded();
  bus.cycle();  // begins with a SYNC
  EXPECT_EQ(bus.frames(), 2) << "the other axes go on";
  unconfirmed(0);
  bus.bench.wait(100);
  const std::int32_t meant = bus.drive[0].target;
  bus.cycle();
  ASSERT_TRUE(bus.drive[0].taken);
  EXPECT_EQ(bus.drive[0].taken->target, meant) << "in time for the next SYNC";
  EXPECT_EQ(bus.frames(), 3);
  EXPECT_EQ(not_forwarded(), missed);
}

// A target that waits is replaced, and never leaves after its SYNC.
TEST_F(ProvenForwarding, OnlyTheNewestWaits) {
  bus.cycle();
  unconfirmed(kFirst);
  const std::uint64_t missed = not_forwarded();
  for (int i = 0; i < 2; ++i) {
    bus.move(1000);
    bus.cycle();
    EXPECT_EQ(bus.frames(), 2);
  }
  EXPECT_EQ(not_forwarded(), missed + 1) << "one has missed its SYNC, one still waits";
  unconfirmed(0);
  bus.bench.wait(100);
  const std::int32_t newest = bus.drive[0].target;
  bus.cycle();
  EXPECT_EQ(bus.drive[0].taken->target, newest);
}

TEST_F(ProvenForwarding, ALateTargetIsToldAndOverAfterCleanCycles) {
  EXPECT_EQ(late(), 0U);
  unconfirmed(kFirst);
  bus.cycle();
  EXPECT_EQ(late(), 1U);
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::forwarded_late, kAxisX));
  EXPECT_FALSE(bus.bench.emergency(ErrorCode::forwarded_late, kAxisX + 1));
  unconfirmed(0);
  bus.cycles(150);
  EXPECT_EQ(late(), 1U);
  EXPECT_FALSE(bus.bench.node->device().emergency().active(ErrorCode::forwarded_late, kAxisX));
  EXPECT_FALSE(bus.bench.emergency(ErrorCode::forwarding_ended, 0));
}

// Each leaves in time and is on the bus only after its SYNC: more than 2200h:04 of them in a row
// are as bad as a node that stands still.
TEST_F(ProvenForwarding, EndsWhenTargetAfterTargetIsLate) {
  const auto allowed = static_cast<int>(bus.bench.number(0x2200, 4));
  const auto late_cycle = [this] {
    unconfirmed(kAll);
    bus.cycle();
    unconfirmed(0);
    bus.bench.wait(100);
  };
  for (int i = 0; i < allowed; ++i)
    late_cycle();
  EXPECT_FALSE(bus.bench.emergency(ErrorCode::forwarding_ended, 0));
  late_cycle();
  bus.cycles(30);  // 1015h: emergencies are 10 ms apart
  EXPECT_TRUE(bus.bench.emergency(ErrorCode::forwarding_ended, 0));
  EXPECT_EQ(bus.frames(), 0);
  EXPECT_TRUE(bus.bit15());
}

// Of a drive that takes no targets none is missed.
TEST_F(ProvenForwarding, DoesNotCountWhereNobodyFollows) {
  bus.enable(false);
  bus.cycles(20);
  unconfirmed(kAll);
  bus.cycles(10);
  EXPECT_EQ(late(), 0U);
  unconfirmed(0);
  bus.cycles(2);
  EXPECT_EQ(bus.frames(), 3);
}

TEST_F(ProvenForwarding, ErrorsOfTheControllerAreCounted) {
  bus.bench.node->controller_errors(3);
  EXPECT_EQ(bus.bench.number(0x2605, 0), 3U);
  bus.bench.node->controller_errors(0xFFFF'FFFE);
  EXPECT_EQ(bus.bench.number(0x2605, 0), 0xFFFF'FFFFU) << "saturates";
}

}  // namespace
}  // namespace volcomp::node
