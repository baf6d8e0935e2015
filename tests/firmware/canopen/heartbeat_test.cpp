// Heartbeat (CiA 301, sections 7.2.8.2.2 and 7.2.8.3.2): produced with 1017h, watched with 1016h,
// and what 1029h makes of a loss.

#include "tests/firmware/canopen/test_device.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// --- producer

TEST_F(DeviceTest, HeartbeatCarriesTheState) {
  ASSERT_EQ(write({0x1017, 0}, 100, 2), AbortCode::none);
  EXPECT_THAT(sent_after_ms(100), ElementsAre(frame(0x705, {0x7F})));
  start();
  EXPECT_THAT(sent_after_ms(100), ElementsAre(frame(0x705, {0x05})));
  stop();
  EXPECT_THAT(sent_after_ms(100), ElementsAre(frame(0x705, {0x04})));
}

TEST_F(DeviceTest, HeartbeatPeriodIsThatOf1017h) {
  ASSERT_EQ(write({0x1017, 0}, 20, 2), AbortCode::none);
  EXPECT_THAT(sent_after_ms(1000), AllOf(SizeIs(50), Each(frame(0x705, {0x7F}))));
}

TEST_F(DeviceTest, NoHeartbeatWithPeriodZero) {
  EXPECT_THAT(sent_after_ms(5000), IsEmpty());
  ASSERT_EQ(write({0x1017, 0}, 20, 2), AbortCode::none);
  ASSERT_EQ(write({0x1017, 0}, 0, 2), AbortCode::none);
  EXPECT_THAT(sent_after_ms(5000), IsEmpty());
}

TEST_F(DeviceTest, HeartbeatsThatCouldNotLeaveAreNotMadeUpFor) {
  ASSERT_EQ(write({0x1017, 0}, 20, 2), AbortCode::none);
  pass_ms(500);
  start();
  EXPECT_THAT(sent(), ElementsAre(frame(0x705, {0x05}))) << "one, with the present state";
}

// --- consumer

// Watches node 3 for 50 ms.
class HeartbeatConsumption : public DeviceTest {
 protected:
  void SetUp() override { ASSERT_EQ(write({0x1016, 2}, 0x0003'0032, 4), AbortCode::none); }

  void heartbeat_of_3(unsigned state = 5) { receive(0x703, {state}); }
  void lose_3() {
    heartbeat_of_3();
    sent_after_ms(51);
  }
};

TEST_F(HeartbeatConsumption, StartsWithTheFirstMessage) {
  EXPECT_THAT(sent_after_ms(1000), IsEmpty());
  EXPECT_FALSE(device.heartbeats().alive(3));
  heartbeat_of_3();
  EXPECT_TRUE(device.heartbeats().alive(3));
  EXPECT_EQ(device.heartbeats().state(3), NmtState::operational);
}

TEST_F(HeartbeatConsumption, LossIsReportedOnceWithTheNode) {
  heartbeat_of_3();
  EXPECT_THAT(sent_after_ms(50), IsEmpty()) << "the time has not passed yet";
  EXPECT_THAT(sent_after_ms(500), ElementsAre(frame(0x085, {0x30, 0x81, 0x11, 3, 0, 0, 0, 0})));
  EXPECT_FALSE(device.heartbeats().alive(3));
  ASSERT_THAT(application.heartbeats, SizeIs(1));
  EXPECT_EQ(application.heartbeats[0].node, 3);
  EXPECT_EQ(application.heartbeats[0].event, HeartbeatEvent::lost);
}

TEST_F(HeartbeatConsumption, RegularHeartbeatsKeepItQuiet) {
  for (int i = 0; i < 20; ++i) {
    heartbeat_of_3();
    EXPECT_THAT(sent_after_ms(49), IsEmpty());
  }
}

TEST_F(HeartbeatConsumption, ReturnIsReportedWithErrorReset) {
  lose_3();
  heartbeat_of_3();
  EXPECT_THAT(sent(), ElementsAre(frame(0x085, {0, 0, 0, 3, 0x30, 0x81, 0, 0})));
  ASSERT_THAT(application.heartbeats, SizeIs(2));
  EXPECT_EQ(application.heartbeats[1].event, HeartbeatEvent::back);
}

TEST_F(HeartbeatConsumption, BootUpOfAWatchedNodeIsReported) {
  heartbeat_of_3();
  heartbeat_of_3(0);
  ASSERT_THAT(application.heartbeats, SizeIs(1));
  EXPECT_EQ(application.heartbeats[0].event, HeartbeatEvent::booted);
}

TEST_F(HeartbeatConsumption, OtherNodesAndFramesAreNotWatched) {
  receive(0x704, {5});
  receive(0x703, {5, 0});
  receive(0x703, {});
  EXPECT_THAT(sent_after_ms(1000), IsEmpty());
}

TEST_F(HeartbeatConsumption, SecondEntryForANodeIsRefused) {
  EXPECT_EQ(write({0x1016, 5}, 0x0003'0064, 4), AbortCode::incompatible_parameter);
  EXPECT_EQ(static_cast<std::uint32_t>(AbortCode::incompatible_parameter), 0x0604'0043U);
  EXPECT_EQ(write({0x1016, 5}, 0x0003'0000, 4), AbortCode::none) << "time 0: not used";
  EXPECT_EQ(write({0x1016, 2}, 0x0003'0064, 4), AbortCode::none) << "its own entry";
  EXPECT_EQ(write({0x1016, 5}, 0x0004'0064, 4), AbortCode::none) << "another node";
}

// CiA 301, 7.5.2.17: time 0, node 0 and nodes above 127 mark an entry as not used; bits 24 to 31
// are reserved.
TEST_F(HeartbeatConsumption, EntriesThatAreNotUsedAreTaken) {
  constexpr std::array<std::uint32_t, 7> kNotUsed{
      0, 0x0000'0064, 0x0080'0064, 0x0083'0064, 0x00FF'FFFF, 0x0080'0000, 0x0003'0000};
  for (const std::uint32_t entry : kNotUsed) {
    for (const std::uint8_t sub : std::array<std::uint8_t, 2>{1, 3}) {  // none is a second one
      EXPECT_EQ(write({0x1016, sub}, entry, 4), AbortCode::none) << std::hex << entry;
      EXPECT_EQ(value_of({0x1016, sub}), entry);
    }
    receive(0x700, {5});
    receive(0x77F, {5});
    EXPECT_THAT(sent_after_ms(1000), IsEmpty()) << std::hex << entry;
  }
  EXPECT_EQ(write({0x1016, 1}, 0x0100'0000, 4), AbortCode::value_too_high);
}

// CiA 301, 7.5.2.17: of others.
TEST_F(HeartbeatConsumption, ADeviceDoesNotWatchItself) {
  EXPECT_EQ(write({0x1016, 1}, (std::uint32_t{kNode} << 16U) + 100U, 4), AbortCode::invalid_value);
}

TEST(HeartbeatConsumer, KnowsNothingOfNodesThatAreNotWatched) {
  CommunicationObjects values;
  values.consumer_heartbeat[0] = 0x0003'0032;
  values.consumer_heartbeat[1] = 0x0004'0000;  // no time: not watched
  HeartbeatConsumer consumer(values);
  HeartbeatEvent event{};
  EXPECT_TRUE(consumer.heard(3, NmtState::boot_up, 0, event));
  for (const std::uint8_t node : std::array<std::uint8_t, 3>{0, 4, 9}) {
    EXPECT_FALSE(consumer.heard(node, NmtState::boot_up, 0, event)) << +node;
    EXPECT_FALSE(consumer.alive(node)) << +node;
    EXPECT_EQ(consumer.state(node), NmtState::boot_up) << +node;
  }
  EXPECT_TRUE(consumer.alive(3));
}

// Nodes 3 and 4 are watched for 50 and 20 ms.
class OverdueHeartbeats : public ::testing::Test {
 protected:
  OverdueHeartbeats() {
    values.consumer_heartbeat[1] = 0x0003'0032;
    values.consumer_heartbeat[6] = 0x0004'0014;
  }
  void hear(std::uint8_t node, std::uint64_t now_us) {
    HeartbeatEvent event{};
    static_cast<void>(consumer.heard(node, NmtState::operational, now_us, event));
  }
  // 0: none.
  std::uint8_t overdue(std::uint64_t now_us) {
    std::uint8_t node = 0;
    return consumer.overdue(now_us, node) ? node : std::uint8_t{0};
  }

  CommunicationObjects values;
  HeartbeatConsumer consumer{values};
};

TEST_F(OverdueHeartbeats, NobodyIsBeforeTheFirstMessage) {
  EXPECT_EQ(consumer.next_overdue_us(), UINT64_MAX);
  EXPECT_EQ(overdue(UINT64_MAX - 1), 0);
  EXPECT_EQ(consumer.next_overdue_us(), UINT64_MAX);
}

TEST_F(OverdueHeartbeats, TheFirstToBeIsDueNext) {
  hear(3, 1000);
  EXPECT_LE(consumer.next_overdue_us(), 51'001U);
  EXPECT_EQ(overdue(1000), 0);
  EXPECT_EQ(consumer.next_overdue_us(), 51'001U);
  hear(4, 2000);
  EXPECT_LE(consumer.next_overdue_us(), 22'001U);
  EXPECT_EQ(overdue(2000), 0);
  EXPECT_EQ(consumer.next_overdue_us(), 22'001U);
  EXPECT_EQ(overdue(22'000), 0);
  EXPECT_EQ(overdue(22'001), 4);
  EXPECT_EQ(overdue(22'001), 0);
  EXPECT_EQ(consumer.next_overdue_us(), 51'001U);
  EXPECT_EQ(overdue(51'001), 3);
  EXPECT_EQ(overdue(51'001), 0);
  EXPECT_EQ(consumer.next_overdue_us(), UINT64_MAX);
}

TEST_F(OverdueHeartbeats, AllOfACallAreReportedOneByOne) {
  hear(3, 0);
  hear(4, 0);
  EXPECT_EQ(overdue(100'000), 3);
  EXPECT_EQ(overdue(100'000), 4);
  EXPECT_EQ(overdue(100'000), 0);
}

TEST_F(OverdueHeartbeats, WhatIsHeardPutsItOff) {
  hear(4, 0);
  hear(4, 15'000);
  EXPECT_LE(consumer.next_overdue_us(), 35'001U);
  EXPECT_EQ(overdue(20'001), 0);
  EXPECT_EQ(consumer.next_overdue_us(), 35'001U);
  EXPECT_EQ(overdue(35'000), 0);
  EXPECT_EQ(overdue(35'001), 4);
}

TEST_F(OverdueHeartbeats, OneThatIsBackCanBeAgain) {
  hear(4, 0);
  EXPECT_EQ(overdue(20'001), 4);
  hear(4, 30'000);
  EXPECT_EQ(overdue(50'000), 0);
  EXPECT_EQ(overdue(50'001), 4);
}

TEST_F(OverdueHeartbeats, OneThatIsNoLongerWatchedIsNot) {
  hear(3, 0);
  hear(4, 0);
  values.consumer_heartbeat[6] = 0;
  std::uint8_t lost = 0;
  EXPECT_FALSE(consumer.restart(7, lost));
  EXPECT_EQ(overdue(50'000), 0);
  EXPECT_EQ(consumer.next_overdue_us(), 50'001U);
  consumer.reset();
  EXPECT_EQ(consumer.next_overdue_us(), UINT64_MAX);
  EXPECT_EQ(overdue(50'001), 0);
}

TEST_F(OverdueHeartbeats, AreCountedAcrossTheEndOfTheClock) {
  constexpr std::uint64_t kBefore = UINT64_MAX - 999;  // 1000 µs before it begins anew
  hear(4, kBefore);
  EXPECT_EQ(overdue(UINT64_MAX), 0);
  EXPECT_EQ(overdue(0), 0);
  EXPECT_EQ(overdue(19'000), 0);
  EXPECT_EQ(overdue(19'001), 4);
}

TEST_F(HeartbeatConsumption, NewEntryIsWatchedFromItsFirstHeartbeat) {
  heartbeat_of_3();
  ASSERT_EQ(write({0x1016, 2}, 0x0003'0032, 4), AbortCode::none);
  EXPECT_THAT(sent_after_ms(1000), IsEmpty());
}

TEST_F(HeartbeatConsumption, OtherEntriesStayWatchedWhenOneChanges) {
  heartbeat_of_3();
  ASSERT_EQ(write({0x1016, 1}, 0x0004'0032, 4), AbortCode::none);
  EXPECT_THAT(sent_after_ms(51), ElementsAre(frame(0x085, {0x30, 0x81, 0x11, 3, 0, 0, 0, 0})));
}

TEST_F(HeartbeatConsumption, ErrorGoesWithTheEntryOfALostNode) {
  lose_3();
  ASSERT_EQ(write({0x1016, 2}, 0, 4), AbortCode::none);
  EXPECT_EQ(value_of({0x1001, 0}), 0U);
}

TEST_F(HeartbeatConsumption, LostNodeWatchedAnewCanBeLostAgain) {
  lose_3();
  ASSERT_EQ(write({0x1016, 2}, 0x0003'0064, 4), AbortCode::none);
  heartbeat_of_3();
  sent();
  EXPECT_THAT(sent_after_ms(101), ElementsAre(frame(0x085, {0x30, 0x81, 0x11, 3, 0, 0, 0, 0})));
}

// --- 1029h

class ErrorBehaviourOf : public HeartbeatConsumption {
 protected:
  NmtState after_loss(std::uint32_t behaviour) {
    EXPECT_EQ(write({0x1029, 1}, behaviour, 1), AbortCode::none);
    start();
    lose_3();
    return device.state();
  }
};

TEST_F(ErrorBehaviourOf, ZeroLeavesOperational) {
  EXPECT_EQ(after_loss(0), NmtState::pre_operational);
}
TEST_F(ErrorBehaviourOf, OneChangesNothing) { EXPECT_EQ(after_loss(1), NmtState::operational); }
TEST_F(ErrorBehaviourOf, TwoStops) { EXPECT_EQ(after_loss(2), NmtState::stopped); }

TEST_F(ErrorBehaviourOf, ThreeIsRefused) {
  EXPECT_EQ(write({0x1029, 1}, 3, 1), AbortCode::value_too_high);
}

TEST_F(ErrorBehaviourOf, ZeroLeavesStoppedAlone) {
  stop();
  lose_3();
  EXPECT_EQ(device.state(), NmtState::stopped);
}

TEST_F(ErrorBehaviourOf, LossThatIsNoErrorChangesNothing) {
  application.loss_is_error = false;
  EXPECT_EQ(after_loss(2), NmtState::operational);
}

TEST_F(ErrorBehaviourOf, TwoKeepsTheEmergencyUntilItMayBeSent) {
  EXPECT_EQ(after_loss(2), NmtState::stopped);
  EXPECT_THAT(sent(), IsEmpty()) << "no EMCY in STOPPED";
  receive(0x000, {0x80, 5});
  EXPECT_THAT(sent(), ElementsAre(frame(0x085, {0x30, 0x81, 0x11, 3, 0, 0, 0, 0})));
}

}  // namespace
}  // namespace volcomp::canopen::test
