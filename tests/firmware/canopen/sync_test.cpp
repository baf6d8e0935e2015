// SYNC (CiA 301, section 7.2.5, objects 1005h, 1006h, 1019h): consumer that keeps the count,
// producer that keeps the period and never competes.

#include "tests/firmware/canopen/test_device.hpp"

namespace volcomp::canopen::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// --- consumer

class SyncConsumer : public ::testing::Test {
 protected:
  SyncVerdict count(unsigned counter) { return sync.received(frame(0x080, {counter})); }
  void count_to(unsigned last) {
    for (unsigned i = 1; i <= last; ++i)
      ASSERT_EQ(count(i), SyncVerdict::good);
  }

  CommunicationObjects objects = with_counter(240);
  Sync sync{objects};

 private:
  static CommunicationObjects with_counter(std::uint8_t overflow) {
    CommunicationObjects objects;
    objects.sync_counter_overflow = overflow;
    return objects;
  }
};

TEST_F(SyncConsumer, CounterWrapsFrom240To1) {
  for (unsigned i = 0; i < 1000; ++i) {
    ASSERT_EQ(count(i % 240 + 1), SyncVerdict::good);
    ASSERT_EQ(sync.counter(), i % 240 + 1);
  }
  EXPECT_EQ(sync.missed(), 0U);
  EXPECT_EQ(sync.foreign(), 0U);
}

TEST_F(SyncConsumer, FirstCounterMayBeAny) {
  EXPECT_EQ(count(117), SyncVerdict::good);
  EXPECT_EQ(count(118), SyncVerdict::good);
  EXPECT_EQ(sync.missed(), 0U);
}

TEST_F(SyncConsumer, LostMessagesAreCounted) {
  count_to(10);
  EXPECT_EQ(count(12), SyncVerdict::good);
  EXPECT_EQ(sync.missed(), 1U);
  EXPECT_EQ(count(16), SyncVerdict::good);
  EXPECT_EQ(sync.missed(), 4U);
}

TEST_F(SyncConsumer, LostMessagesAreCountedAcrossTheWrap) {
  EXPECT_EQ(count(239), SyncVerdict::good);
  EXPECT_EQ(count(2), SyncVerdict::good);
  EXPECT_EQ(sync.missed(), 2U);
}

TEST_F(SyncConsumer, DuplicateIsRejected) {
  count_to(10);
  EXPECT_EQ(count(10), SyncVerdict::foreign);
  EXPECT_EQ(count(11), SyncVerdict::good);
  EXPECT_EQ(sync.missed(), 0U);
}

TEST_F(SyncConsumer, DuplicateIsRejectedWithEveryOverflow) {
  for (unsigned overflow = 2; overflow <= 240; ++overflow) {
    objects.sync_counter_overflow = static_cast<std::uint8_t>(overflow);
    sync.reset();
    ASSERT_EQ(count(1), SyncVerdict::good);
    ASSERT_EQ(count(1), SyncVerdict::foreign) << "1019h = " << overflow;
    ASSERT_EQ(count(2), SyncVerdict::good);
  }
}

TEST_F(SyncConsumer, SecondProducerIsRejectedAndTheFirstGoesOn) {
  for (unsigned i = 1; i <= 60; ++i) {
    ASSERT_EQ(count(i), SyncVerdict::good);
    ASSERT_EQ(count(i + 100), SyncVerdict::foreign);
  }
  EXPECT_EQ(sync.foreign(), 60U);
  EXPECT_EQ(sync.missed(), 0U);
}

TEST_F(SyncConsumer, RestartedProducerIsAcceptedWithItsThirdMessage) {
  count_to(100);
  EXPECT_EQ(count(1), SyncVerdict::foreign);
  EXPECT_EQ(count(2), SyncVerdict::foreign);
  EXPECT_EQ(count(3), SyncVerdict::good);
  EXPECT_EQ(sync.counter(), 3);
  EXPECT_EQ(count(4), SyncVerdict::good);
}

TEST_F(SyncConsumer, ScatteredCountersAreNoRestart) {
  count_to(100);
  for (const unsigned counter : {1U, 2U, 50U, 51U, 9U, 7U, 8U, 30U})
    EXPECT_EQ(count(counter), SyncVerdict::foreign) << counter;
}

TEST_F(SyncConsumer, WrongLengthIsRejected) {
  EXPECT_EQ(sync.received(frame(0x080, {})), SyncVerdict::wrong_length);
  EXPECT_EQ(sync.received(frame(0x080, {1, 0})), SyncVerdict::wrong_length);
  objects.sync_counter_overflow = 0;
  EXPECT_EQ(sync.received(frame(0x080, {1})), SyncVerdict::wrong_length);
  EXPECT_EQ(sync.received(frame(0x080, {})), SyncVerdict::good);
}

TEST_F(SyncConsumer, CountersThatDoNotExistAreRejected) {
  count_to(10);
  EXPECT_NE(count(0), SyncVerdict::good);
  EXPECT_NE(count(241), SyncVerdict::good);
  EXPECT_EQ(count(11), SyncVerdict::good);
}

TEST_F(SyncConsumer, ZeroDoesNotFollow239) {
  EXPECT_EQ(count(239), SyncVerdict::good);
  EXPECT_NE(count(0), SyncVerdict::good);
  EXPECT_EQ(count(240), SyncVerdict::good);
}

// --- in a device

class SyncOfDevice : public DeviceTest {
 protected:
  void produce(std::uint32_t period_us, std::uint32_t overflow) {
    ASSERT_EQ(write({0x1019, 0}, overflow, 1), AbortCode::none);
    ASSERT_EQ(write({0x1006, 0}, period_us, 4), AbortCode::none);
    ASSERT_EQ(write({0x1005, 0}, 0x4000'0080, 4), AbortCode::none);
  }
};

TEST_F(SyncOfDevice, RefusalsReachTheApplicationAndAreNoCycle) {
  ASSERT_EQ(write({0x1019, 0}, 240, 1), AbortCode::none);
  start();
  receive(0x080, {7});
  receive(0x080, {7});
  receive(0x080, {});
  receive(0x080, {8});
  EXPECT_THAT(application.sync_counters, ElementsAre(7, 8));
  EXPECT_THAT(application.bad_syncs, ElementsAre(SyncVerdict::foreign, SyncVerdict::wrong_length));
}

TEST_F(SyncOfDevice, NobodyIsForeignAfterSyncsHeardInStopped) {
  ASSERT_EQ(write({0x1019, 0}, 240, 1), AbortCode::none);
  start();
  receive(0x080, {1});
  stop();
  for (unsigned i = 2; i <= 50; ++i)
    receive(0x080, {i});
  start();
  receive(0x080, {51});
  EXPECT_THAT(application.sync_counters, ElementsAre(1, 51));
  EXPECT_THAT(application.bad_syncs, IsEmpty());
}

TEST_F(SyncOfDevice, SyncIsNotJudgedInStopped) {
  stop();
  receive(0x080, {1, 2, 3});
  EXPECT_THAT(application.bad_syncs, IsEmpty());
}

TEST_F(SyncOfDevice, ProducesWithPeriodAndCounter) {
  produce(4000, 3);
  const std::vector<hal::CanFrame> frames = sent_after_ms(20);
  EXPECT_THAT(frames, ElementsAre(frame(0x080, {1}), frame(0x080, {2}), frame(0x080, {3}),
                                  frame(0x080, {1}), frame(0x080, {2})));
}

TEST_F(SyncOfDevice, ProducesWithoutCounter) {
  produce(10'000, 0);
  EXPECT_THAT(sent_after_ms(20), ElementsAre(frame(0x080, {}), frame(0x080, {})));
}

TEST_F(SyncOfDevice, OwnSyncIsACycleOfItsOwn) {
  produce(4000, 240);
  start();
  sent_after_ms(12);
  EXPECT_THAT(application.sync_counters, ElementsAre(1, 2, 3));
}

TEST_F(SyncOfDevice, LateProducerSendsNoBurst) {
  produce(4000, 0);
  sent_after_ms(1);
  now_us += 100'000;
  device.poll(now_us);
  EXPECT_THAT(sent(), SizeIs(1));
  device.poll(now_us);
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(SyncOfDevice, NoPeriodNoSync) {
  produce(0, 0);
  EXPECT_THAT(sent_after_ms(100), IsEmpty());
}

TEST_F(SyncOfDevice, NewPeriodBeginsWithinItself) {
  produce(1'000'000, 0);
  sent_after_ms(10);
  ASSERT_EQ(write({0x1006, 0}, 4000, 4), AbortCode::none);
  EXPECT_THAT(sent_after_ms(4), SizeIs(1));
}

TEST_F(SyncOfDevice, CounterBeginsWithOneAfterStopped) {
  produce(4000, 240);
  sent_after_ms(40);
  stop();
  EXPECT_THAT(sent_after_ms(40), IsEmpty()) << "no SYNC in STOPPED";
  receive(0x000, {0x80, kNode});
  EXPECT_THAT(sent_after_ms(4), ElementsAre(frame(0x080, {1})));
}

TEST_F(SyncOfDevice, StepsBackBesideAnotherProducer) {
  produce(4000, 240);
  start();
  sent_after_ms(9);
  receive(0x080, {77});
  EXPECT_THAT(application.bad_syncs, ElementsAre(SyncVerdict::foreign));
  EXPECT_THAT(sent_after_ms(100), IsEmpty());
  EXPECT_EQ(value_of({0x1005, 0}), 0x80U) << "bit 30 shows it";
  receive(0x080, {78});
  EXPECT_EQ(application.sync_counters.back(), 78) << "and follows the other one";
}

TEST_F(SyncOfDevice, SyncThatWaitsIsNotSentAfterAnotherProducers) {
  produce(4000, 240);
  pass_ms(1);
  receive(0x080, {77});
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(SyncOfDevice, IdentifierIsFixedWhileProducing) {
  EXPECT_EQ(write({0x1005, 0}, 0x0000'0101, 4), AbortCode::invalid_value) << "reserved";
  produce(4000, 0);
  EXPECT_EQ(write({0x1005, 0}, 0x4000'0690, 4), AbortCode::invalid_value);
  EXPECT_EQ(write({0x1005, 0}, 0x0000'0080, 4), AbortCode::none);
  EXPECT_EQ(write({0x1005, 0}, 0x0000'0690, 4), AbortCode::none);
}

TEST_F(SyncOfDevice, ExtendedIdentifiersAreRefused) {
  EXPECT_EQ(write({0x1005, 0}, 0x2000'0080, 4), AbortCode::invalid_value);
  EXPECT_EQ(write({0x1005, 0}, 0x0000'0880, 4), AbortCode::invalid_value);
}

TEST_F(SyncOfDevice, ReservedOverflowsAreRefused) {
  EXPECT_EQ(write({0x1019, 0}, 1, 1), AbortCode::invalid_value);
  EXPECT_EQ(write({0x1019, 0}, 241, 1), AbortCode::value_too_high);
  EXPECT_EQ(write({0x1019, 0}, 2, 1), AbortCode::none);
  EXPECT_EQ(write({0x1019, 0}, 240, 1), AbortCode::none);
}

// CiA 301, 7.5.2.22: 0800 0022h, in every state.
TEST_F(SyncOfDevice, OverflowIsFixedWhileThereIsACyclePeriod) {
  ASSERT_EQ(write({0x1006, 0}, 4000, 4), AbortCode::none);
  EXPECT_EQ(write({0x1019, 0}, 240, 1), AbortCode::device_state) << "PRE-OPERATIONAL";
  start();
  EXPECT_EQ(write({0x1019, 0}, 240, 1), AbortCode::device_state);
  EXPECT_EQ(static_cast<std::uint32_t>(AbortCode::device_state), 0x0800'0022U);
  ASSERT_EQ(write({0x1006, 0}, 0, 4), AbortCode::none);
  EXPECT_EQ(write({0x1019, 0}, 240, 1), AbortCode::none);
}

// CiA 301, table 40; 081h is EMCY of node 1.
TEST_F(SyncOfDevice, RestrictedIdentifiersAreRefused) {
  for (const std::uint32_t id :
       {0x000U, 0x07FU, 0x100U, 0x101U, 0x180U, 0x581U, 0x67FU, 0x6E0U, 0x701U, 0x7FFU})
    EXPECT_EQ(write({0x1005, 0}, id, 4), AbortCode::invalid_value) << std::hex << id;
}

// CiA 301, table 40 restricts none of 080h to 0FFh; on its own EMCY the device sends something
// else.
TEST_F(SyncOfDevice, IdentifiersOfEmergenciesOfOthersMayBeSync) {
  for (std::uint32_t id = 0x080; id <= 0x0FF; ++id) {
    const AbortCode expected = id == 0x080U + kNode ? AbortCode::invalid_value : AbortCode::none;
    EXPECT_EQ(write({0x1005, 0}, id, 4), expected) << std::hex << id;
  }
  ASSERT_EQ(write({0x1005, 0}, 0x081, 4), AbortCode::none);
  EXPECT_EQ(value_of({0x1005, 0}), 0x081U);
  start();
  receive(0x080, {});
  EXPECT_THAT(application.sync_counters, IsEmpty());
  receive(0x081, {});
  EXPECT_THAT(application.sync_counters, SizeIs(1));
}

}  // namespace
}  // namespace volcomp::canopen::test
