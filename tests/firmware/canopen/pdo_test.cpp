// PDOs at run time (CiA 301, section 7.2.2): when they are sent, when what they bring takes effect.

#include "tests/firmware/canopen/test_device.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct Timing {
  std::uint8_t type = 255;
  std::uint16_t inhibit_100us = 0;
  std::uint16_t event_timer_ms = 0;
};

class Pdos : public DeviceTest {
 protected:
  static constexpr std::uint16_t kTpdo = 0x185;
  static constexpr std::uint16_t kRpdo = 0x205;

  // TPDO 1 carries 6041h.
  void transmit(const Timing& timing) {
    PdoParameters p;
    p.cob_id = kTpdo;
    p.type = timing.type;
    p.inhibit_100us = timing.inhibit_100us;
    p.event_timer_ms = timing.event_timer_ms;
    p.count = 1;
    p.mapping = {mapped(0x6041, 0, 16)};
    ASSERT_EQ(tpdos[0].configure(p, PdoKind::transmit, device.objects()), AbortCode::none);
    start();
  }
  // RPDO 1 carries 607Ah.
  void listen(std::uint8_t type) {
    PdoParameters p;
    p.cob_id = kRpdo;
    p.type = type;
    p.count = 1;
    p.mapping = {mapped(0x607A, 0, 32)};
    ASSERT_EQ(rpdos[0].configure(p, PdoKind::receive, device.objects()), AbortCode::none);
    start();
  }
  void sync() { receive(0x080, {}); }
  void target(unsigned low_byte) { receive(kRpdo, {low_byte, 0, 0, 0}); }
};

// --- TPDO

TEST_F(Pdos, TypeZeroIsSentAtTheSyncAfterItsEvent) {
  transmit({0});
  sync();
  EXPECT_THAT(sent(), IsEmpty());
  device.trigger(0);
  EXPECT_THAT(sent(), IsEmpty());
  sync();
  EXPECT_THAT(sent(), SizeIs(1));
  sync();
  EXPECT_THAT(sent(), IsEmpty()) << "once per event";
}

TEST_F(Pdos, TypeOneIsSentAtEverySync) {
  transmit({1});
  EXPECT_THAT(sent(), IsEmpty());
  for (int i = 0; i < 3; ++i) {
    sync();
    EXPECT_THAT(sent(), SizeIs(1));
  }
}

TEST_F(Pdos, TypeNIsSentAtEveryNthSync) {
  for (const std::uint8_t n : {std::uint8_t{2}, std::uint8_t{7}, std::uint8_t{240}}) {
    transmit({n});
    receive(0x000, {0x80, kNode});
    start();
    std::size_t count = 0;
    for (int i = 0; i < 10 * n; ++i) {
      sync();
      count += sent().size();
    }
    EXPECT_EQ(count, 10U) << +n;
  }
}

TEST_F(Pdos, CountToNBeginsAnewInOperational) {
  transmit({3});
  sync();
  sync();
  receive(0x000, {0x80, kNode});
  start();
  sync();
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Pdos, TypesAbove253AreSentAtTheirEvent) {
  for (const std::uint8_t type : {std::uint8_t{254}, std::uint8_t{255}}) {
    transmit({type});
    sync();
    EXPECT_THAT(sent(), IsEmpty());
    device.trigger(0);
    objects.status = 0x1234;
    EXPECT_THAT(sent(), ElementsAre(frame(kTpdo, {0x34, 0x12})));
    EXPECT_THAT(sent(), IsEmpty());
  }
}

TEST_F(Pdos, EventTimerSendsAtLeastSoOften) {
  transmit({255, 0, 10});
  sent_after_ms(1);
  EXPECT_THAT(sent_after_ms(100), SizeIs(10));
}

TEST_F(Pdos, EventRestartsTheEventTimer) {
  transmit({255, 0, 10});
  sent_after_ms(1);
  pass_ms(6);
  device.trigger(0);
  EXPECT_THAT(sent(), SizeIs(1));
  EXPECT_THAT(sent_after_ms(9), IsEmpty());
  EXPECT_THAT(sent_after_ms(1), SizeIs(1));
}

TEST_F(Pdos, InhibitTimeLiesBetweenTwo) {
  transmit({255, 30, 0});  // 3 ms
  device.trigger(0);
  EXPECT_THAT(sent(), SizeIs(1));
  device.trigger(0);
  now_us += 2999;
  EXPECT_THAT(sent(), IsEmpty());
  now_us += 1;
  EXPECT_THAT(sent(), SizeIs(1)) << "late, not lost";
}

TEST_F(Pdos, LatestValueWins) {
  transmit({255});
  objects.status = 1;
  device.trigger(0);
  hal::CanFrame refused;
  ASSERT_TRUE(device.offer(refused, now_us));
  EXPECT_EQ(refused, frame(kTpdo, {1, 0}));
  objects.status = 2;
  device.trigger(0);
  EXPECT_THAT(sent(), ElementsAre(frame(kTpdo, {2, 0})));
}

TEST_F(Pdos, WithdrawnOfferIsNotSent) {
  transmit({255});
  device.trigger(0);
  device.withdraw(0);
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Pdos, WithdrawnEventIsNotSentAtTheNextSync) {
  transmit({0});
  device.trigger(0);
  device.withdraw(0);
  sync();
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Pdos, InvalidPdoIsNeverSent) {
  transmit({1});
  ASSERT_EQ(write({0x1800, 1}, 0x8000'0185, 4), AbortCode::none);
  device.trigger(0);
  sync();
  EXPECT_THAT(sent(), IsEmpty());
}

// --- RPDO

TEST_F(Pdos, EventDrivenRpdoTakesEffectAtOnce) {
  listen(255);
  target(7);
  EXPECT_EQ(objects.target, 7);
  EXPECT_THAT(application.received_ids, ElementsAre(kRpdo));
}

TEST_F(Pdos, SynchronousRpdoTakesEffectAtTheNextSync) {
  for (const std::uint8_t type : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{240}}) {
    listen(type);
    objects.target = 0;
    target(7);
    EXPECT_EQ(objects.target, 0) << +type;
    sync();
    EXPECT_EQ(objects.target, 7) << +type;
    EXPECT_EQ(application.target_at_sync.back(), 7) << "before the application's cycle";
  }
}

TEST_F(Pdos, SynchronousRpdoKeepsOnlyItsLatestFrame) {
  listen(1);
  target(7);
  target(8);
  sync();
  sync();
  EXPECT_EQ(objects.target, 8);
  EXPECT_THAT(application.received_ids, SizeIs(1));
}

TEST_F(Pdos, RpdoBeforeOperationalHasNoEffect) {
  listen(1);
  receive(0x000, {0x80, kNode});
  target(7);
  start();
  sync();
  EXPECT_EQ(objects.target, 0);
}

TEST_F(Pdos, RpdoThatWaitedDoesNotSurviveAStateChange) {
  listen(1);
  target(7);
  receive(0x000, {0x80, kNode});
  start();
  sync();
  EXPECT_EQ(objects.target, 0);
}

TEST_F(Pdos, RpdoAfterTheWindowIsDropped) {
  ASSERT_EQ(write({0x1007, 0}, 2000, 4), AbortCode::none);
  listen(1);
  sync();
  now_us += 2000;
  target(7);
  now_us += 1;
  target(8);
  sync();
  EXPECT_EQ(objects.target, 7);
}

TEST_F(Pdos, WindowDoesNotConcernEventDrivenRpdos) {
  ASSERT_EQ(write({0x1007, 0}, 2000, 4), AbortCode::none);
  listen(255);
  sync();
  now_us += 3000;
  target(7);
  EXPECT_EQ(objects.target, 7);
}

TEST_F(Pdos, ShortRpdoIsAnErrorUntilALongOneComes) {
  listen(255);
  receive(kRpdo, {7, 0, 0});
  receive(kRpdo, {7, 0, 0});
  EXPECT_EQ(objects.target, 0);
  EXPECT_THAT(sent(), ElementsAre(frame(0x085, {0x10, 0x82, 0x11, 1, 3, 4, 0, 0})));
  receive(kRpdo, {7, 0, 0, 0});
  EXPECT_THAT(sent(), ElementsAre(frame(0x085, {0, 0, 0, 1, 0x10, 0x82, 0, 0})));
}

TEST_F(Pdos, LongerRpdoIsTakenWithItsFirstBytes) {
  listen(255);
  receive(kRpdo, {7, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF});
  EXPECT_EQ(objects.target, 7);
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(Pdos, TwoRpdosMayShareAFrame) {
  listen(255);
  PdoParameters p;
  p.cob_id = kRpdo;
  p.type = 255;
  p.count = 1;
  p.mapping = {mapped(0x6040, 0, 16)};
  ASSERT_EQ(rpdos[1].configure(p, PdoKind::receive, device.objects()), AbortCode::none);
  receive(kRpdo, {0x04, 0x03, 0x02, 0x01});
  EXPECT_EQ(objects.target, 0x0102'0304);
  EXPECT_EQ(objects.control, 0x0304);
}

}  // namespace
}  // namespace volcomp::canopen::test
