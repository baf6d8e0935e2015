// A node that watches a grinder over the bus, learns offsets of C and puts them out.

#include <cmath>

#include "comp/core/crc32.hpp"
#include "firmware/node/store/record_storage.hpp"
#include "tests/firmware/node/strokes/stroke_bench.hpp"
#include "tests/hal/memory_blocks.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;

using Errors = StrokeBench::Errors;

class NodeStrokes : public ::testing::Test {
 protected:
  void SetUp() override {
    grinder.configure();
    grinder.start();
  }
  std::uint64_t number(std::uint16_t index, std::uint8_t sub) {
    return grinder.bench.number(index, sub);
  }
  Reason reason(std::uint16_t index, std::uint8_t sub) {
    return static_cast<Reason>(number(index, sub));
  }

  StrokeBench grinder;
};

// C ahead by the same everywhere: what the flank gets is its lever times that.
TEST_F(NodeStrokes, ShowWhatTheFlankGets) {
  grinder.grind([](auto, bool, double) { return Errors{0.0, 40e-6}; });
  EXPECT_EQ(number(0x2510, 10), 3U) << "passes up";
  EXPECT_EQ(number(0x2510, 11), 3U) << "passes down";
  EXPECT_NEAR(grinder.real(0x2512, 2), 40e-6 * kLever * 1e3, 1e-4) << "mean, forward";
  EXPECT_NEAR(grinder.real(0x2513, 5), 40e-6 * kLever * 1e3, 1e-4) << "RMS, backward";
  EXPECT_NEAR(grinder.means(1).at(5), 40e-6, 2 * kWireStep);
  EXPECT_NEAR(grinder.means(3).at(1), 0.0, 2 * kWireStep) << "no slot differs from the others";
  EXPECT_EQ(number(0x2510, 9), 0U);
  EXPECT_EQ(grinder.offset(), 0.0);
}

// A lag of both axes along the helix moves the wheel along the flank and leaves nothing.
TEST_F(NodeStrokes, ALagAlongTheHelixIsNoError) {
  grinder.grind([](auto, bool up, double) {
    const double lag = up ? -0.16 : 0.16;
    return Errors{lag, -lag * kTurnPerMm};
  });
  EXPECT_NEAR(grinder.real(0x2512, 2), 0.0, 2e-3);
  EXPECT_NEAR(std::abs(grinder.real(0x2512, 7)), 0.16 * kTurnPerMm * kLever * 1e3, 1e-2);
  EXPECT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.grind({});
  EXPECT_NEAR(grinder.most, 0.0, 2 * kWireStep);
  const auto predicted = grinder.floats(0x2525);
  EXPECT_NEAR(std::abs(predicted[0]), 38.9, 0.1) << "Z alone";
  EXPECT_NEAR(std::abs(predicted[1]), 38.9, 0.1) << "C alone";
  EXPECT_NEAR(predicted[2], 0.0, 0.01);
}

// With w = 1/2 every step halves what is left.
TEST_F(NodeStrokes, LearnTheErrorAway) {
  const auto error = [](std::uint16_t, bool up, double) {
    return Errors{0.0, up ? 40e-6 : -24e-6};
  };
  double left = 1.0;
  for (int step = 0; step < 6; ++step) {
    grinder.grind(error);
    EXPECT_NEAR(grinder.real(0x2512, 5), left * 40e-6 * kLever * 1e3, 2e-3) << step;
    EXPECT_NEAR(grinder.real(0x2513, 5), left * 24e-6 * kLever * 1e3, 2e-3) << step;
    ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
    left *= 0.5;
  }
  grinder.grind(error);
  EXPECT_NEAR(grinder.least, -40e-6 * (1.0 - left), 3 * kWireStep) << "up";
  EXPECT_NEAR(grinder.most, 24e-6 * (1.0 - left), 3 * kWireStep) << "down: a table of its own";
  EXPECT_EQ(number(0x2521, 1), 0U) << "kept";
  EXPECT_EQ(number(0x2521, 3), 11U) << "nodes";
}

// Slot 1 stands 20 µrad apart: the stroke tables get the mean, the slot table the rest.
TEST_F(NodeStrokes, SlotsHaveATableOfTheirOwn) {
  const auto error = [](std::uint16_t slot, bool, double) {
    return Errors{0.0, slot == 1 ? 30e-6 : 0.0};
  };
  grinder.grind(error);
  EXPECT_NEAR(grinder.means(1).at(4), 10e-6, 2 * kWireStep);
  EXPECT_NEAR(grinder.means(3).at(1), 20e-6, 2 * kWireStep);
  EXPECT_NEAR(grinder.means(3).at(2), -10e-6, 2 * kWireStep);
  for (int step = 0; step < 8; ++step) {
    ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
    grinder.grind(error);
  }
  EXPECT_NEAR(grinder.least, -30e-6, 30e-6 / 256 + 3 * kWireStep);
  EXPECT_NEAR(grinder.most, 0.0, 30e-6 / 256 + 3 * kWireStep);
}

// C alone breaks the helix (docs/papers/internal-helical.md, "What is wrong in it").
TEST_F(NodeStrokes, CAloneIsRefusedUnlessForced) {
  ASSERT_EQ(grinder.bench.set<std::uint8_t>(0x2520, 2, 3), AbortCode::none);
  grinder.grind([](auto, bool, double) { return Errors{-0.16, 0.16 * kTurnPerMm}; });
  EXPECT_EQ(grinder.learn(LearnCommand::learn), AbortCode::general);
  EXPECT_EQ(reason(0x2520, 4), Reason::breaks_helix);
  EXPECT_EQ(number(0x2524, 1), 0U);
  ASSERT_EQ(grinder.bench.set<std::uint8_t>(0x2520, 3, 1), AbortCode::none);
  grinder.grind([](auto, bool, double) { return Errors{-0.16, 0.16 * kTurnPerMm}; });
  EXPECT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
}

TEST_F(NodeStrokes, NothingIsLearnedFromNothing) {
  EXPECT_EQ(grinder.learn(LearnCommand::learn), AbortCode::general);
  EXPECT_EQ(reason(0x2520, 4), Reason::too_few_points);
  EXPECT_EQ(grinder.learn(LearnCommand::resume), AbortCode::general);
  EXPECT_EQ(reason(0x2520, 4), Reason::not_staged);
  Bytes none;
  EXPECT_EQ(grinder.bench.read({0x2526, 1}, none), AbortCode::no_data);
}

// A change in the middle of a slot would be a step on the flank.
TEST_F(NodeStrokes, TablesComeIntoForceAtTheEndOfAStroke) {
  const auto error = [](auto, bool, double) { return Errors{0.0, 40e-6}; };
  grinder.grind(error);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.bench.cycles(20);
  EXPECT_EQ(number(0x2524, 1), 1U) << "waits";
  EXPECT_EQ(grinder.offset(), 0.0);
  EXPECT_EQ(grinder.learn(LearnCommand::learn), AbortCode::general);
  EXPECT_EQ(reason(0x2520, 4), Reason::hand_over_pending);
  grinder.grind(error);
  EXPECT_EQ(number(0x2524, 1), 2U);
  EXPECT_EQ(number(0x2524, 2), static_cast<std::uint64_t>(StrokeBench::kFeed_nm_per_s));
}

TEST_F(NodeStrokes, StopAndResume) {
  const auto error = [](auto, bool, double) { return Errors{0.0, 40e-6}; };
  grinder.grind(error);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.grind(error);
  EXPECT_NEAR(grinder.least, -20e-6, 2 * kWireStep);
  ASSERT_EQ(grinder.learn(LearnCommand::stop), AbortCode::none);
  grinder.grind(error);
  EXPECT_EQ(grinder.offset(), 0.0);
  ASSERT_EQ(grinder.learn(LearnCommand::resume), AbortCode::none);
  grinder.grind(error);
  EXPECT_NEAR(grinder.least, -20e-6, 2 * kWireStep);
  ASSERT_EQ(grinder.learn(LearnCommand::start_over), AbortCode::none);
  grinder.grind(error);
  EXPECT_EQ(grinder.offset(), 0.0);
  Bytes none;
  EXPECT_EQ(grinder.bench.read({0x2526, 1}, none), AbortCode::no_data);
}

// --- what goes wrong on the bus

// More than one sample in a hundred: the pass does not count.
TEST_F(NodeStrokes, APassWithLostProcessStatesDoesNotCount) {
  grinder.process_state_lost = [](std::uint16_t slot, bool up, double z) {
    return slot == 1 && up && std::abs(z) < 0.35;
  };
  grinder.grind([](auto, bool, double) { return Errors{0.0, 40e-6}; });
  EXPECT_EQ(number(0x2510, 9), 1U) << "discarded";
  EXPECT_EQ(number(0x2510, 10), 2U);
  EXPECT_EQ(number(0x2510, 11), 3U);
  EXPECT_NEAR(grinder.real(0x2512, 2), 40e-6 * kLever * 1e3, 1e-4);
}

TEST_F(NodeStrokes, WithoutProcessStateTheOffsetIsHeldAndThenGoes) {
  const auto error = [](auto, bool, double) { return Errors{0.0, 40e-6}; };
  grinder.grind(error);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  bool gone = false;
  int cycles = 0;
  grinder.process_state_lost = [&](std::uint16_t slot, bool, double z) {
    gone = gone || (slot == 2 && z > 0.0);
    if (gone && ++cycles == 10) {
      EXPECT_NEAR(grinder.offset(), -20e-6, 2 * kWireStep) << "held";
    }
    return gone;
  };
  grinder.grind(error);
  EXPECT_EQ(grinder.offset(), 0.0);
  EXPECT_NE(number(0x2524, 3) & kDropped, 0U);
  EXPECT_LE(grinder.bench.largest_step, 70'000) << "half of the slew limit: 2^-31 turn";
}

// Tables hold for one feed, 2 % either way.
TEST_F(NodeStrokes, AnotherFeedIsNotCorrectedAndNotLearned) {
  const auto error = [](auto, bool, double) { return Errors{0.0, 40e-6}; };
  grinder.grind(error);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.feed_nm_per_s = StrokeBench::kFeed_nm_per_s / 100 * 103;
  grinder.grind(error);
  EXPECT_EQ(grinder.offset(), 0.0);
  EXPECT_NE(number(0x2524, 3) & kOtherFeed, 0U);
  EXPECT_EQ(grinder.learn(LearnCommand::learn), AbortCode::general);
  EXPECT_EQ(reason(0x2520, 4), Reason::feed_mismatch);
  ASSERT_EQ(grinder.learn(LearnCommand::forget), AbortCode::none);
  grinder.feed_nm_per_s = StrokeBench::kFeed_nm_per_s / 100 * 101;
  grinder.grind(error);
  EXPECT_NEAR(grinder.least, -20e-6, 2 * kWireStep);
}

// --- tables as bytes

class LearnedTablesOfANode : public NodeStrokes {
 protected:
  void SetUp() override {
    NodeStrokes::SetUp();
    grinder.grind([](auto, bool, double) { return Errors{0.0, 40e-6}; });
    ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
    image = grinder.image();
    ASSERT_EQ(image.size(), kLearnedHeader + 4 * (2 * 11 + 3) + 4);
  }
  AbortCode download(const Bytes& bytes) { return grinder.bench.write({0x2526, 1}, bytes); }
  // `change` of an image that is sealed again.
  template <class T>
  Bytes changed(std::size_t at, T value) const {
    Bytes bytes = image;
    std::memcpy(&bytes[at], &value, sizeof value);
    const std::size_t end = bytes.size() - 4;
    store_le(&bytes[end], 4, crc32({bytes.data(), end}));
    return bytes;
  }
  void expect_refused(const Bytes& bytes, Reason why) {
    EXPECT_EQ(download(bytes), AbortCode::general) << code(why);
    EXPECT_EQ(reason(0x2526, 2), why) << code(why);
    EXPECT_EQ(grinder.image(), image) << "the last good tables stay";
  }

  Bytes image;
};

TEST_F(LearnedTablesOfANode, ComeBackAsTheyWere) {
  ASSERT_EQ(grinder.learn(LearnCommand::start_over), AbortCode::none);
  ASSERT_EQ(download(image), AbortCode::none);
  EXPECT_EQ(grinder.image(), image);
  grinder.grind({});
  ASSERT_EQ(grinder.learn(LearnCommand::resume), AbortCode::none);
  grinder.grind({});
  EXPECT_NEAR(grinder.least, -20e-6, 2 * kWireStep);
}

TEST_F(LearnedTablesOfANode, TornAndForeignOnesAreRefused) {
  Bytes torn(image.begin(), image.end() - 8);
  expect_refused(torn, Reason::image_truncated);
  expect_refused(Bytes(image.begin(), image.begin() + 10), Reason::image_truncated);
  for (std::size_t bit = 0; bit < 8 * image.size(); bit += 37) {
    Bytes flipped = image;
    flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_EQ(download(flipped), AbortCode::general) << bit;
  }
  expect_refused(changed(0, 'X'), Reason::bad_magic);
  expect_refused(changed(16, std::int64_t{0}), Reason::length_mismatch);
  expect_refused(changed(24, std::uint32_t{250'000}), Reason::length_mismatch);
  expect_refused(changed(28, std::int32_t{0}), Reason::bad_setting);
  expect_refused(changed(kLearnedHeader, NAN), Reason::not_finite);
  expect_refused(changed(kLearnedHeader + 40, 3e-3F), Reason::bound_exceeded);
}

// --- settings

class StrokeSettings : public ::testing::Test {
 protected:
  void SetUp() override { grinder.configure(); }
  AbortCode switch_on() { return grinder.bench.set<std::uint8_t>(0x2500, 1, 1); }
  void expect_refused(Reason why, const char* field) {
    EXPECT_EQ(switch_on(), AbortCode::invalid_value) << field;
    EXPECT_EQ(grinder.bench.number(0x2500, 11), static_cast<std::uint64_t>(why)) << field;
    EXPECT_STREQ(grinder.bench.text(0x2500, 12).c_str(), field);
    EXPECT_EQ(grinder.bench.number(0x2500, 1), 0U) << "off";
  }

  StrokeBench grinder;
};

TEST_F(StrokeSettings, AreCheckedWhenTheyAreTakenOver) {
  EXPECT_EQ(switch_on(), AbortCode::none);
  ASSERT_EQ(grinder.bench.set<std::uint8_t>(0x2500, 4, 0), AbortCode::none);
  expect_refused(Reason::bad_setting, "axis");
  ASSERT_EQ(grinder.bench.set<std::uint8_t>(0x2500, 4, 1), AbortCode::none);
  expect_refused(Reason::bad_setting, "axis");
  ASSERT_EQ(grinder.bench.set<std::uint8_t>(0x2500, 4, 3), AbortCode::none);
  ASSERT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 6, 1), AbortCode::none);
  expect_refused(Reason::too_few_knots, "");
  ASSERT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 6, 262), AbortCode::none);
  expect_refused(Reason::too_many_knots, "");
  ASSERT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 6, 11), AbortCode::none);
  ASSERT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 5, 129), AbortCode::none);
  expect_refused(Reason::bad_setting, "slots");
  ASSERT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 5, 3), AbortCode::none);
  ASSERT_EQ(grinder.bench.set<std::uint64_t>(0x2501, 2, 0x7FF8'0000'0000'0000U), AbortCode::none);
  expect_refused(Reason::not_finite, "flank_per_rad");
}

TEST_F(StrokeSettings, DoNotChangeWhileTheAxesMove) {
  grinder.start();
  EXPECT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 6, 5), AbortCode::device_state);
  EXPECT_EQ(switch_on(), AbortCode::device_state);
}

TEST_F(StrokeSettings, OffNothingIsWatched) {
  grinder.bench.load(stroke_tables());
  grinder.bench.nmt(canopen::NmtCommand::start);
  grinder.grind([](auto, bool, double) { return Errors{0.0, 40e-6}; });
  EXPECT_EQ(grinder.learn(LearnCommand::learn), AbortCode::device_state);
  EXPECT_EQ(grinder.bench.number(0x2510, 1), 0U);
}

// Without tables of the machine nothing is sent to C: no offset is pretended.
TEST_F(StrokeSettings, WithoutTablesOfTheMachineThereIsNoOffset) {
  ASSERT_EQ(switch_on(), AbortCode::none);
  grinder.bench.nmt(canopen::NmtCommand::start);
  const auto error = [](auto, bool, double) { return Errors{0.0, 40e-6}; };
  grinder.grind(error);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.grind(error);
  EXPECT_EQ(grinder.bench.number(0x2524, 4), 0U);
  EXPECT_EQ(grinder.bench.number(0x2524, 3), kNoAuthority);
}

// Settings written since they were taken over wait for 2500h:01.
TEST_F(StrokeSettings, StartingOverKeepsThoseInForce) {
  grinder.start();
  const auto error = [](auto, bool, double) { return Errors{0.0, 40e-6}; };
  grinder.grind(error);
  grinder.bench.nmt(canopen::NmtCommand::enter_pre_operational);
  ASSERT_EQ(grinder.bench.set<std::uint16_t>(0x2500, 6, 5), AbortCode::none);
  ASSERT_EQ(grinder.learn(LearnCommand::start_over), AbortCode::none);
  EXPECT_EQ(grinder.means(1).size(), 11U);
}

TEST_F(StrokeSettings, APeriodOfSecondsIsRefused) {
  ASSERT_EQ(grinder.bench.set<std::uint32_t>(0x1006, 0, 10'000'000), AbortCode::none);
  expect_refused(Reason::bad_setting, "tick_ns");
}

// --- store

// Saved, powered off, back: the offset is there from the end of the first stroke on.
TEST(StoredStrokes, ComeBackWithTheirTables) {
  using Blocks = test::MemoryBlocks<16384, 2>;
  const auto blocks = std::make_unique<Blocks>();
  RecordStorage<Blocks> storage{*blocks};
  StrokeBench grinder(&storage);
  grinder.configure();
  grinder.start();
  const auto error = [](auto, bool, double z) { return Errors{0.0, 40e-6 + z * 1e-6}; };
  grinder.grind(error);
  ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
  grinder.grind(error);
  const Bytes image = grinder.image();
  grinder.bench.nmt(canopen::NmtCommand::enter_pre_operational);
  ASSERT_EQ(grinder.bench.set<std::uint32_t>(0x1010, 1, kSave), AbortCode::none);

  grinder.bench.power_on();
  EXPECT_EQ(grinder.bench.number(0x2500, 1), 1U) << "on";
  EXPECT_EQ(grinder.image(), image);
  grinder.bench.nmt(canopen::NmtCommand::start);
  grinder.grind(error, 2);
  EXPECT_EQ(grinder.bench.number(0x2524, 1), 2U);
  EXPECT_NEAR(grinder.least, -22.5e-6, 1e-6);
}

}  // namespace
}  // namespace volcomp::node
