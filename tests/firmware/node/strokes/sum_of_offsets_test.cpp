// The learned offset of C and that of its tables go out as a sum, which keeps the limits of the
// axis.

#include "tests/firmware/node/strokes/stroke_bench.hpp"

namespace volcomp::node {
namespace {

using canopen::AbortCode;

using Errors = StrokeBench::Errors;

class SumOfOffsets : public ::testing::Test {
 protected:
  static constexpr std::int32_t kAcceleration = 400;                  // 2^-32 turn
  static constexpr std::int32_t kMostChange = kAcceleration / 2 + 2;  // drive units, rounded
  // Of a round, in which the rate of the learned offset alone holds it back: it changes by up to
  // 60 urad, 41 000 units, 10 000 in a cycle.
  static constexpr int kCyclesAtItsRate = 10;

  void configure(std::int32_t acceleration) {
    grinder.configure();
    EXPECT_EQ(grinder.bench.set(0x2209, 3, acceleration), AbortCode::none);
  }
  // Learns, and grinds with what was learned.
  void learn() {
    grinder.start();
    const auto error = [](std::uint16_t slot, bool up, double) {
      return Errors{0.0, (up ? 40e-6 : -24e-6) + (slot == 1 ? 20e-6 : 0.0)};
    };
    for (int step = 0; step < 3; ++step) {
      grinder.grind(error);
      ASSERT_EQ(grinder.learn(LearnCommand::learn), AbortCode::none);
    }
    grinder.process_state_lost = [this](auto, bool, double) {
      const std::uint16_t status = grinder.bench.node->objects().stroke.offset_status;
      clamped += (status & kClamped) != 0 ? 1 : 0;
      held_back += (status & kRateLimited) != 0 ? 1 : 0;
      return false;
    };
    grinder.grind(error);
  }

  StrokeBench grinder;
  int clamped = 0;  // cycles of the last round, by 2524h:03
  int held_back = 0;
};

TEST_F(SumOfOffsets, ALearnedOffsetChangesItsStepByNoMore) {
  configure(kAcceleration);
  learn();
  EXPECT_LT(grinder.least, -30e-6) << "or nothing was learned";
  EXPECT_LE(grinder.largest_change, kMostChange);
  EXPECT_GT(grinder.largest_change, kMostChange / 2) << "or there was nothing to be limited";
  EXPECT_GT(held_back, 5 * kCyclesAtItsRate);
  EXPECT_EQ(clamped, 0);
  EXPECT_FALSE(grinder.bench.emergency(canopen::ErrorCode::correction_jumped, 3));
}

TEST_F(SumOfOffsets, NorWhereTheLimitCutsItOff) {
  constexpr std::int32_t kLimit = 12'000;  // 2^-32 turn: 17.6 urad
  configure(kAcceleration);
  EXPECT_EQ(grinder.bench.set(0x2201, 3, kLimit), AbortCode::none);
  learn();
  EXPECT_NEAR(grinder.least, -kLimit * kWireStep / 2.0, 2 * kWireStep);
  EXPECT_LE(grinder.largest_change, kMostChange);
  EXPECT_GT(held_back, 5 * kCyclesAtItsRate);
  EXPECT_GT(clamped, 300) << "half of a round";
  EXPECT_FALSE(grinder.bench.emergency(canopen::ErrorCode::correction_jumped, 3));
}

TEST_F(SumOfOffsets, WithoutABoundItsRateAloneCounts) {
  configure(0);
  learn();
  EXPECT_GT(grinder.largest_change, 10 * kMostChange);
  EXPECT_LE(held_back, kCyclesAtItsRate);
  EXPECT_EQ(clamped, 0);
}

}  // namespace
}  // namespace volcomp::node
