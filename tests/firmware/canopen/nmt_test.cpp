// Network management (CiA 301, section 7.3.2): what a device does at which command, and what it may
// send in which state.

#include "tests/firmware/canopen/test_device.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class Nmt : public DeviceTest {
 protected:
  static constexpr std::uint16_t kTpdo = 0x185;

  // TPDO 1 reports 6041h at every SYNC.
  void map_synchronous_tpdo() {
    ASSERT_EQ(write({0x1A00, 1}, 0x6041'0010, 4), AbortCode::none);
    ASSERT_EQ(write({0x1A00, 0}, 1, 1), AbortCode::none);
    ASSERT_EQ(write({0x1800, 2}, 1, 1), AbortCode::none);
    ASSERT_EQ(write({0x1800, 1}, kPdoNoRtr | kTpdo, 4), AbortCode::none);
  }
};

TEST_F(Nmt, BootUpIsOneZeroByte) {
  device.power_on(now_us);
  EXPECT_THAT(sent(), ElementsAre(frame(0x705, {0})));
  EXPECT_EQ(device.state(), NmtState::pre_operational);
}

TEST_F(Nmt, PowerOnResetsApplicationThenCommunication) {
  EXPECT_THAT(application.resets, ElementsAre("application", "communication"));
}

TEST_F(Nmt, CommandsToThisNodeAreObeyed) {
  receive(0x000, {0x01, 5});
  EXPECT_EQ(device.state(), NmtState::operational);
  receive(0x000, {0x80, 5});
  EXPECT_EQ(device.state(), NmtState::pre_operational);
  receive(0x000, {0x02, 5});
  EXPECT_EQ(device.state(), NmtState::stopped);
  EXPECT_THAT(application.states, ElementsAre(NmtState::pre_operational, NmtState::operational,
                                              NmtState::pre_operational, NmtState::stopped));
}

TEST_F(Nmt, CommandsToAllNodesAreObeyed) {
  receive(0x000, {0x01, 0});
  EXPECT_EQ(device.state(), NmtState::operational);
  receive(0x000, {0x02, 0});
  EXPECT_EQ(device.state(), NmtState::stopped);
  receive(0x000, {0x80, 0});
  EXPECT_EQ(device.state(), NmtState::pre_operational);
}

TEST_F(Nmt, CommandsToAnotherNodeAreIgnored) {
  for (const unsigned command : {0x01U, 0x02U, 0x81U, 0x82U})
    receive(0x000, {command, 6});
  EXPECT_EQ(device.state(), NmtState::pre_operational);
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Nmt, WhatIsNoCommandIsIgnored) {
  receive(0x000, {0x01});
  receive(0x000, {0x01, 5, 0});
  receive(0x000, {0x03, 5});
  receive(0x000, {});
  EXPECT_EQ(device.state(), NmtState::pre_operational);
}

TEST_F(Nmt, RepeatedCommandIsNoChange) {
  start();
  start();
  EXPECT_THAT(application.states, ElementsAre(NmtState::pre_operational, NmtState::operational));
}

TEST_F(Nmt, ResetNodeResetsBothAreasAndBootsUp) {
  start();
  application.resets.clear();
  receive(0x000, {0x81, 5});
  EXPECT_THAT(application.resets, ElementsAre("application", "communication"));
  EXPECT_THAT(sent(), ElementsAre(frame(0x705, {0})));
  EXPECT_EQ(device.state(), NmtState::pre_operational);
}

TEST_F(Nmt, ResetCommunicationLeavesTheApplication) {
  stop();
  application.resets.clear();
  receive(0x000, {0x82, 0});
  EXPECT_THAT(application.resets, ElementsAre("communication"));
  EXPECT_THAT(sent(), ElementsAre(frame(0x705, {0})));
  EXPECT_EQ(device.state(), NmtState::pre_operational);
}

TEST_F(Nmt, BootUpPrecedesEverythingElse) {
  receive(0x000, {0x81, 5});
  start();
  receive(0x605, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0});
  device.emergency().raise(ErrorCode::can_overrun, 0);
  const std::vector<hal::CanFrame> frames = sent();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0], frame(0x705, {0}));
}

TEST_F(Nmt, ProcessDataOnlyInOperational) {
  map_synchronous_tpdo();
  receive(0x080, {});
  EXPECT_THAT(sent(), IsEmpty());
  start();
  receive(0x080, {});
  EXPECT_THAT(sent(), ElementsAre(frame(kTpdo, {0, 0})));
  stop();
  receive(0x080, {});
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Nmt, ProcessDataNotTakenInTimeAreNotSentLater) {
  map_synchronous_tpdo();
  start();
  receive(0x080, {});
  receive(0x000, {0x80, 5});
  EXPECT_THAT(sent(), IsEmpty());
  start();
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Nmt, SyncIsACycleOnlyInOperational) {
  receive(0x080, {});
  start();
  receive(0x080, {});
  stop();
  receive(0x080, {});
  EXPECT_EQ(application.sync_counters.size(), 1U);
}

TEST_F(Nmt, SdoIsServedUnlessStopped) {
  const std::vector<unsigned> read_device_type{0x40, 0x00, 0x10, 0, 0, 0, 0, 0};
  receive(0x605, read_device_type);
  EXPECT_EQ(sent().size(), 1U);
  start();
  receive(0x605, read_device_type);
  EXPECT_EQ(sent().size(), 1U);
  stop();
  receive(0x605, read_device_type);
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Nmt, NothingThatWaitedIsSentInStopped) {
  objects.communication.cycle_period_us = 4000;
  objects.communication.sync_cob_id = 0x4000'0080;
  receive(0x605, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0});
  device.emergency().raise(ErrorCode::can_overrun, 0);
  device.poll(now_us);
  hal::CanFrame refused;
  ASSERT_TRUE(device.offer(refused, now_us));
  ASSERT_EQ(refused.id, 0x080);
  stop();
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Nmt, ResponseOfferedBeforeStopIsNotSentAfterwards) {
  receive(0x605, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0});
  hal::CanFrame refused;
  ASSERT_TRUE(device.offer(refused, now_us));
  ASSERT_EQ(refused.id, 0x585);
  stop();
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Nmt, SdoTransferDoesNotSurviveStop) {
  receive(0x605, {0x21, 0x10, 0x20, 0, 100, 0, 0, 0});
  ASSERT_EQ(sent().size(), 1U);
  stop();
  EXPECT_EQ(application.domains_abandoned, 1);
}

}  // namespace
}  // namespace volcomp::canopen::test
