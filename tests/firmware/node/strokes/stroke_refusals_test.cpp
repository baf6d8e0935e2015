// Strokes on the bus: what is refused, what is missing, and that nothing of it reaches C.

#include <cmath>
#include <cstring>

#include "comp/core/crc32.hpp"
#include "tests/firmware/node/strokes/stroke_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;

using Errors = StrokeBench::Errors;

Errors ahead(std::uint16_t /*slot*/, bool /*up*/, double /*z*/) { return {0.0, 40e-6}; }

class StrokeRefusals : public ::testing::Test {
 protected:
  void SetUp() override { grinder.configure(); }

  AbortCode set_real(std::uint16_t index, std::uint8_t sub, double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return grinder.bench.set<std::uint64_t>(index, sub, bits);
  }
  AbortCode switch_on() { return grinder.bench.set<std::uint8_t>(0x2500, 1, 1); }
  Reason reason(std::uint16_t index, std::uint8_t sub) {
    return static_cast<Reason>(grinder.bench.number(index, sub));
  }
  // Settings, changed and changed back.
  template <class T>
  void expect_refused(std::uint16_t index, std::uint8_t sub, T bad, T good, const char* field) {
    const auto set = [&](T value) {
      if constexpr (std::is_same_v<T, double>) {
        EXPECT_EQ(set_real(index, sub, value), AbortCode::none);
      } else {
        EXPECT_EQ(grinder.bench.set<T>(index, sub, value), AbortCode::none);
      }
    };
    set(bad);
    EXPECT_EQ(switch_on(), AbortCode::invalid_value) << field;
    EXPECT_EQ(grinder.bench.text(0x2500, 12), field);
    EXPECT_EQ(grinder.bench.number(0x2500, 1), 0U) << "off";
    set(good);
    EXPECT_EQ(switch_on(), AbortCode::none) << field;
    EXPECT_EQ(grinder.bench.text(0x2500, 12), "");
  }
  void expect_not_learned(Reason why) {
    EXPECT_EQ(grinder.learn(LearnCommand::learn), AbortCode::general) << code(why);
    EXPECT_EQ(reason(0x2520, 4), why);
  }
  void start_with(const MachineTables& tables) {
    ASSERT_EQ(switch_on(), AbortCode::none);
    grinder.bench.load(tables);
    grinder.bench.nmt(canopen::NmtCommand::start);
  }

  StrokeBench grinder;
};

// --- settings

TEST_F(StrokeRefusals, SettingsByName) {
  expect_refused<std::uint8_t>(0x2500, 3, 1, 2, "axis");  // Z is X
  expect_refused<std::uint8_t>(0x2500, 3, 3, 2, "axis");  // Z is C
  expect_refused(0x2504, 4, 6.1e-3, 2e-3, "largest offset");
  expect_refused(0x2504, 4, std::nan(""), 2e-3, "largest offset");
  expect_refused(0x2504, 1, 0.0, 0.5, "weight");
  expect_refused<std::uint16_t>(0x2500, 5, 0, StrokeBench::kSlots, "");
  EXPECT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 10, 0), AbortCode::value_too_low);
  EXPECT_EQ(grinder.bench.set<std::int32_t>(0x2500, 9, 0), AbortCode::value_too_low);
}

TEST_F(StrokeRefusals, WhileOffThereIsNothingToReadWriteOrLearn) {
  grinder.start();
  grinder.grind(ahead);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  const Bytes image = grinder.image();
  grinder.bench.nmt(canopen::NmtCommand::enter_pre_operational);
  ASSERT_EQ(grinder.bench.set<std::uint8_t>(0x2500, 1, 0), AbortCode::none);
  Bytes none;
  EXPECT_EQ(grinder.bench.read({0x2516, 1}, none), AbortCode::no_data);
  EXPECT_EQ(grinder.bench.read({0x2526, 1}, none), AbortCode::no_data);
  EXPECT_EQ(grinder.bench.write({0x2526, 1}, image), AbortCode::general);
  EXPECT_EQ(reason(0x2526, 2), Reason::bad_setting);
}

// --- learning

TEST_F(StrokeRefusals, NoCommandIsNoError) {
  grinder.start();
  grinder.grind(ahead);
  EXPECT_EQ(grinder.learn(LearnCommand::none), AbortCode::none);
  EXPECT_EQ(grinder.bench.number(0x2524, 1), 0U);
  EXPECT_EQ(grinder.bench.number(0x2510, 10), 3U) << "nothing is forgotten";
}

// A node that corrects C alone offers two of the four targets.
TEST_F(StrokeRefusals, TargetsThatNeedZ) {
  grinder.start();
  grinder.grind(ahead);
  for (const LearningTarget target : {LearningTarget::z_and_c, LearningTarget::z_alone}) {
    ASSERT_EQ(grinder.bench.set<std::uint8_t>(0x2520, 2, static_cast<std::uint8_t>(target)),
              AbortCode::none);
    expect_not_learned(Reason::bad_setting);
  }
}

TEST_F(StrokeRefusals, FeedsThatDifferAndNone) {
  grinder.start();
  grinder.grind(ahead);
  grinder.feed_nm_per_s = StrokeBench::kFeed_nm_per_s / 100 * 103;
  grinder.grind(ahead);
  expect_not_learned(Reason::feed_mismatch);
  ASSERT_EQ(grinder.learn(LearnCommand::forget), AbortCode::none);
  grinder.feed_nm_per_s = 0;
  grinder.grind(ahead);
  expect_not_learned(Reason::bad_setting);
  EXPECT_EQ(grinder.bench.number(0x2524, 1), 0U);
}

TEST_F(StrokeRefusals, TablesThatWaitAreNotPutInForceTwice) {
  grinder.start();
  grinder.grind(ahead);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  EXPECT_EQ(grinder.learn(LearnCommand::resume), AbortCode::general);
  EXPECT_EQ(reason(0x2520, 4), Reason::hand_over_pending);
  grinder.grind(ahead);
  EXPECT_NEAR(grinder.least, -20e-6, 2 * kWireStep);
}

// One axis alone breaks the helix only where both follow one, of whichever hand.
TEST_F(StrokeRefusals, CAloneBreaksAHelixOfEitherHandAndNoSpurGear) {
  const auto learns_c_alone = [](double turn_per_mm) {
    StrokeBench bench;
    bench.configure();
    Bytes bytes(sizeof turn_per_mm);
    std::memcpy(bytes.data(), &turn_per_mm, sizeof turn_per_mm);
    EXPECT_EQ(bench.bench.write({0x2501, 1}, bytes), AbortCode::none);
    EXPECT_EQ(bench.bench.set<std::uint8_t>(0x2520, 2, 3), AbortCode::none);
    bench.start();
    bench.grind(ahead);
    return bench.learn(LearnCommand::learn);
  };
  EXPECT_EQ(learns_c_alone(kTurnPerMm), AbortCode::general);
  EXPECT_EQ(learns_c_alone(-kTurnPerMm), AbortCode::general);
  EXPECT_EQ(learns_c_alone(0.0), AbortCode::none);
}

TEST_F(StrokeRefusals, NodesThatWereNeverReachedHaveNoMean) {
  ASSERT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 6, 16), AbortCode::none);
  grinder.start();
  grinder.grind(ahead);
  const auto means = grinder.means(1);
  ASSERT_EQ(means.size(), 16U);
  EXPECT_NEAR(means.at(5), 40e-6, 2 * kWireStep);
  EXPECT_EQ(means.at(14), 0.0F);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  EXPECT_EQ(grinder.bench.number(0x2521, 3), 11U) << "updated";
  EXPECT_EQ(grinder.bench.number(0x2521, 5), 5U) << "skipped";
}

// --- on the bus

TEST_F(StrokeRefusals, ALearnedOffsetStaysWithinTheLimitOfTheAxis) {
  constexpr double kLimit = 10'000 * 2.0 * kPi / 4294967296.0;
  ASSERT_EQ(grinder.bench.set<std::int32_t>(0x2201, 3, 10'000), AbortCode::none);
  grinder.start();
  const auto both_ways = [](std::uint16_t, bool up, double) {
    return Errors{0.0, up ? 40e-6 : -40e-6};
  };
  grinder.grind(both_ways);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.grind(both_ways);
  EXPECT_NEAR(grinder.least, -kLimit, 2 * kWireStep);
  EXPECT_NEAR(grinder.most, kLimit, 2 * kWireStep);
}

// Another axis that corrects gets its own offsets only.
TEST_F(StrokeRefusals, OnlyCGetsWhatWasLearned) {
  MachineTables tables = stroke_tables();
  tables.machine.correcting = {0, 2};
  tables.machine.correcting_count = 2;
  start_with(tables);
  grinder.grind(ahead, 2);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.grind(ahead);
  EXPECT_NEAR(grinder.least, -20e-6, 2 * kWireStep);
  EXPECT_EQ(grinder.bench.drive[0].held, 0);
}

TEST_F(StrokeRefusals, WhereCDoesNotCorrectThereIsNoOffset) {
  MachineTables tables = stroke_tables();
  tables.machine.correcting = {0};
  start_with(tables);
  grinder.grind(ahead, 2);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.grind(ahead);
  EXPECT_EQ(grinder.offset(), 0.0);
  EXPECT_EQ(grinder.bench.number(0x2524, 3), kNoAuthority);
}

// An axis whose frames are missing, or that has lost its reference: the pass does not count, and
// the offset goes.
TEST_F(StrokeRefusals, AnAxisThatIsSilentOrNotReferencedIsNotFollowed) {
  grinder.start();
  grinder.grind(ahead);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.grind(ahead);
  ASSERT_NEAR(grinder.least, -20e-6, 2 * kWireStep);
  ASSERT_EQ(grinder.learn(LearnCommand::forget), AbortCode::none);
  for (const std::size_t axis : {1U, 2U}) {
    grinder.bench.drive[axis].silent = true;
    grinder.grind(ahead);
    EXPECT_EQ(grinder.bench.number(0x2510, 10), 0U) << axis;
    EXPECT_NE(grinder.bench.number(0x2524, 3) & kDropped, 0U) << axis;
    grinder.bench.drive[axis].silent = false;
  }
  grinder.grind(ahead);
  for (const std::size_t axis : {1U, 2U}) {
    grinder.bench.drive[axis].status = 0x0027;
    grinder.grind(ahead);
    EXPECT_NE(grinder.bench.number(0x2524, 3) & kNotHomed, 0U) << axis;
    EXPECT_NEAR(grinder.offset(), 0.0, kWireStep) << axis;
    grinder.bench.drive[axis].status = 0x0127;
  }
  grinder.grind(ahead, 2);
  EXPECT_NEAR(grinder.least, -20e-6, 2 * kWireStep) << "back";
}

// --- tables as bytes

class ForeignLearnedTables : public StrokeRefusals {
 protected:
  void SetUp() override {
    StrokeRefusals::SetUp();
    ASSERT_EQ(grinder.bench.set<std::uint32_t>(0x2000, 1, 1003), AbortCode::none);
    grinder.start();
    grinder.grind(ahead);
    ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
    image = grinder.image();
  }
  Bytes with(std::size_t at, std::size_t size, std::uint64_t value) {
    store_le(&image[at], size, value);
    const std::size_t end = image.size() - 4;
    store_le(&image[end], 4, crc32({image.data(), end}));
    return image;
  }
  AbortCode download(const Bytes& bytes) { return grinder.bench.write({0x2526, 1}, bytes); }

  Bytes image;
};

TEST_F(ForeignLearnedTables, OfAnotherMachineAreRefused) {
  EXPECT_EQ(download(image), AbortCode::none);
  EXPECT_EQ(download(with(8, 4, 1004)), AbortCode::general);
  EXPECT_EQ(reason(0x2526, 2), Reason::machine_mismatch);
  EXPECT_EQ(download(with(8, 4, 0)), AbortCode::none) << "of no machine in particular";
}

// As many values, shared out otherwise.
TEST_F(ForeignLearnedTables, OfAnotherShapeAreRefused) {
  with(12, 2, 10);
  EXPECT_EQ(download(with(14, 2, 5)), AbortCode::general);
  EXPECT_EQ(reason(0x2526, 2), Reason::length_mismatch);
}

TEST_F(ForeignLearnedTables, LongerThanAnyAreRefusedAtOnce) {
  EXPECT_EQ(download(Bytes(kMostLearnedBytes + 1)), AbortCode::out_of_memory);
  EXPECT_EQ(grinder.image(), image);
}

// The client dies after the first segment (CiA 301, 7.2.4.3.3).
TEST_F(ForeignLearnedTables, ABrokenDownloadLeavesTheTablesAlone) {
  grinder.bench.give({0x600 + NodeBench::kId, 8, {0x21, 0x26, 0x25, 0x01, 0x88, 0, 0, 0}});
  grinder.bench.give({0x600 + NodeBench::kId, 8, {0x00, 1, 2, 3, 4, 5, 6, 7}});
  grinder.bench.wait(3'000'000);
  EXPECT_EQ(grinder.image(), image);
}

}  // namespace
}  // namespace volcomp::node
