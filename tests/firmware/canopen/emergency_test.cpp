// Emergency (CiA 301, section 7.2.7; error register 1001h, history 1003h, inhibit time 1015h).

#include "tests/firmware/canopen/test_device.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class EmergencyMessages : public DeviceTest {
 protected:
  Emergency& emergency = device.emergency();
};

TEST_F(EmergencyMessages, FrameIsCodeRegisterAndFiveBytes) {
  emergency.raise(ErrorCode::rpdo_timeout, 2, {0xA1, 0xA2, 0xA3, 0xA4});
  EXPECT_THAT(sent(), ElementsAre(frame(0x085, {0x50, 0x82, 0x11, 2, 0xA1, 0xA2, 0xA3, 0xA4})));
}

TEST_F(EmergencyMessages, SameErrorIsReportedOnce) {
  for (int i = 0; i < 10; ++i)
    emergency.raise(ErrorCode::rpdo_timeout, 2);
  EXPECT_THAT(sent(), SizeIs(1));
  EXPECT_EQ(value_of({0x1003, 0}), 1U);
}

TEST_F(EmergencyMessages, SourcesAreToldApart) {
  emergency.raise(ErrorCode::rpdo_timeout, 1);
  emergency.raise(ErrorCode::rpdo_timeout, 2);
  EXPECT_THAT(sent(), SizeIs(2));
  EXPECT_TRUE(emergency.active(ErrorCode::rpdo_timeout, 2));
  EXPECT_FALSE(emergency.active(ErrorCode::rpdo_timeout, 3));
}

TEST_F(EmergencyMessages, EveryRepairIsReportedTheLastWithAnEmptyRegister) {
  emergency.raise(ErrorCode::rpdo_timeout, 1);
  emergency.raise(ErrorCode::axis_clamped, 2);
  sent();
  emergency.clear(ErrorCode::rpdo_timeout, 1);
  EXPECT_THAT(sent(), ElementsAre(frame(0x085, {0, 0, 0x81, 1, 0x50, 0x82, 0, 0})));
  emergency.clear(ErrorCode::axis_clamped, 2);
  EXPECT_THAT(sent(), ElementsAre(frame(0x085, {0, 0, 0x00, 2, 0x03, 0xFF, 0, 0})));
}

TEST_F(EmergencyMessages, RepairOfWhatWasNoErrorIsSilent) {
  emergency.clear(ErrorCode::rpdo_timeout, 1);
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(EmergencyMessages, ErrorMayComeBack) {
  emergency.raise(ErrorCode::rpdo_timeout, 1);
  emergency.clear(ErrorCode::rpdo_timeout, 1);
  emergency.raise(ErrorCode::rpdo_timeout, 1);
  EXPECT_THAT(sent(), SizeIs(3));
}

// More errors than are stored at a time: the first stay, the others are not reported until there is
// room again.
TEST_F(EmergencyMessages, ErrorsBeyondTheRoomForThemAreNotReported) {
  constexpr std::uint8_t kRoom = 64;
  for (std::uint8_t source = 0; source <= kRoom; ++source) {
    emergency.raise(ErrorCode::rpdo_timeout, source);
    sent();
  }
  EXPECT_TRUE(emergency.active(ErrorCode::rpdo_timeout, kRoom - 1));
  EXPECT_FALSE(emergency.active(ErrorCode::rpdo_timeout, kRoom));
  emergency.clear(ErrorCode::rpdo_timeout, 0);
  sent();
  emergency.raise(ErrorCode::rpdo_timeout, kRoom);
  EXPECT_THAT(sent(), SizeIs(1));
}

// Bits 0 generic, 4 communication, 7 manufacturer-specific (CiA 301, section 7.5.2.2).
TEST_F(EmergencyMessages, RegisterShowsTheKindsThatArePresent) {
  EXPECT_EQ(value_of({0x1001, 0}), 0U);
  emergency.raise(ErrorCode::parameters_lost, 0);
  EXPECT_EQ(value_of({0x1001, 0}), 0x01U);
  emergency.raise(ErrorCode::heartbeat, 3);
  EXPECT_EQ(value_of({0x1001, 0}), 0x11U);
  emergency.raise(ErrorCode::table_refused, 0);
  EXPECT_EQ(value_of({0x1001, 0}), 0x91U);
  emergency.clear(ErrorCode::heartbeat, 3);
  EXPECT_EQ(value_of({0x1001, 0}), 0x81U);
  emergency.clear(ErrorCode::table_refused, 0);
  emergency.clear(ErrorCode::parameters_lost, 0);
  EXPECT_EQ(value_of({0x1001, 0}), 0U);
}

TEST_F(EmergencyMessages, InhibitTimeLiesBetweenTwo) {
  ASSERT_EQ(write({0x1015, 0}, 50, 2), AbortCode::none);  // 5 ms
  emergency.raise(ErrorCode::rpdo_timeout, 1);
  emergency.raise(ErrorCode::rpdo_timeout, 2);
  emergency.raise(ErrorCode::rpdo_timeout, 3);
  EXPECT_THAT(sent(), SizeIs(1)) << "the first at once";
  now_us += 4999;
  EXPECT_THAT(sent(), IsEmpty());
  now_us += 1;
  EXPECT_THAT(sent(), SizeIs(1));
  now_us += 5000;
  EXPECT_THAT(sent(), SizeIs(1));
}

TEST_F(EmergencyMessages, FirstOneWaitsForNothing) {
  CommunicationObjects values;
  values.emergency_inhibit_100us = 50;
  Emergency fresh{values};
  fresh.raise(ErrorCode::rpdo_timeout, 1);
  hal::CanFrame message;
  EXPECT_TRUE(fresh.offer(0, message)) << "at the start of time";
}

TEST_F(EmergencyMessages, QueueOverflowIsCounted) {
  for (unsigned source = 0; source < 20; ++source)
    emergency.raise(ErrorCode::rpdo_timeout, static_cast<std::uint8_t>(source));
  const std::vector<hal::CanFrame> frames = sent();
  EXPECT_EQ(frames.size() + emergency.dropped(), 20U);
  EXPECT_GT(emergency.dropped(), 0);
  EXPECT_EQ(frames[0].data[3], 0) << "the oldest is kept";
  EXPECT_EQ(value_of({0x1003, 1}), 0x0013'8250U) << "the history has the newest all the same";
}

TEST_F(EmergencyMessages, QueueKeepsTheOrder) {
  for (int round = 0; round < 5; ++round) {
    for (unsigned source = 1; source <= 7; ++source)
      emergency.raise(ErrorCode::rpdo_timeout, static_cast<std::uint8_t>(source));
    const std::vector<hal::CanFrame> frames = sent();
    ASSERT_THAT(frames, SizeIs(7));
    for (unsigned i = 0; i < 7; ++i)
      EXPECT_EQ(frames[i].data[3], i + 1);
    for (unsigned source = 1; source <= 7; ++source)
      emergency.clear(ErrorCode::rpdo_timeout, static_cast<std::uint8_t>(source));
    EXPECT_THAT(sent(), SizeIs(7));
  }
}

TEST_F(EmergencyMessages, CommunicationResetForgetsErrors) {
  emergency.raise(ErrorCode::rpdo_timeout, 1);
  receive(0x000, {0x82, kNode});
  EXPECT_THAT(sent(), ElementsAre(frame(0x705, {0})));
  EXPECT_EQ(value_of({0x1001, 0}), 0U);
}

TEST_F(EmergencyMessages, IdentifierFollowsTheNode) { EXPECT_EQ(value_of({0x1014, 0}), 0x85U); }

// --- 1003h

TEST_F(EmergencyMessages, HistoryHasTheNewestFirst) {
  emergency.raise(ErrorCode::heartbeat, 3);
  emergency.raise(ErrorCode::rpdo_timeout, 1);
  EXPECT_EQ(value_of({0x1003, 0}), 2U);
  EXPECT_EQ(value_of({0x1003, 1}), 0x0001'8250U);
  EXPECT_EQ(value_of({0x1003, 2}), 0x0003'8130U);
}

TEST_F(EmergencyMessages, HistoryKeepsTheLastEight) {
  for (unsigned source = 1; source <= 11; ++source)
    emergency.raise(ErrorCode::rpdo_timeout, static_cast<std::uint8_t>(source));
  EXPECT_EQ(value_of({0x1003, 0}), 8U);
  EXPECT_EQ(value_of({0x1003, 1}), 0x000B'8250U);
  EXPECT_EQ(value_of({0x1003, 8}), 0x0004'8250U);
}

TEST_F(EmergencyMessages, EmptyPartOfTheHistoryHasNoData) {
  EXPECT_EQ(refusal_of({0x1003, 1}), AbortCode::no_data);
  emergency.raise(ErrorCode::heartbeat, 3);
  EXPECT_EQ(refusal_of({0x1003, 1}), AbortCode::none);
  EXPECT_EQ(refusal_of({0x1003, 2}), AbortCode::no_data);
  EXPECT_EQ(refusal_of({0x1003, 9}), AbortCode::no_subindex);
}

TEST_F(EmergencyMessages, WritingZeroEmptiesTheHistory) {
  emergency.raise(ErrorCode::heartbeat, 3);
  EXPECT_EQ(write({0x1003, 0}, 0, 1), AbortCode::none);
  EXPECT_EQ(value_of({0x1003, 0}), 0U);
  EXPECT_EQ(refusal_of({0x1003, 1}), AbortCode::no_data);
  EXPECT_THAT(objects.communication.error_history, Each(0U));
  EXPECT_EQ(value_of({0x1001, 0}), 0x11U) << "the error itself is still there";
}

TEST_F(EmergencyMessages, OtherValuesAreRefused) {
  emergency.raise(ErrorCode::heartbeat, 3);
  EXPECT_EQ(write({0x1003, 0}, 1, 1), AbortCode::invalid_value);
  EXPECT_EQ(write({0x1003, 0}, 255, 1), AbortCode::invalid_value);
  EXPECT_EQ(write({0x1003, 1}, 0, 4), AbortCode::read_only);
  EXPECT_EQ(value_of({0x1003, 0}), 1U);
}

}  // namespace
}  // namespace volcomp::canopen::test
