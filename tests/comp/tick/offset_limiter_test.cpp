// The limiter of offsets by hand, and its promises under targets meant to break them.

#include <gtest/gtest.h>

#include <vector>

#include "tests/oracle/offset_storm.hpp"
#include "tests/oracle/tick_bench.hpp"

namespace volcomp::test {
namespace {

using Offsets = std::vector<std::int32_t>;

constexpr OffsetLimits kLimits{1'000, 100, 10, 20};

class Limited : public ::testing::Test {
 protected:
  Limited() { begin(kLimits); }
  void begin(const OffsetLimits& limits, std::int32_t held = 0) {
    limiter = {};
    limiter.change(OffsetBounds(limits));
    limiter.start(held);
  }
  Offsets follow(std::int32_t target, int ticks) {
    Offsets offsets;
    for (int n = 0; n < ticks; ++n) {
      status = limiter.follow(target);
      offsets.push_back(limiter.offset());
    }
    return offsets;
  }

  OffsetLimiter<true> limiter;
  std::uint32_t status = 0;
};

// 20, 40, 60, then the steps from which it stops at 200: 46 + 26 + 6 ≤ 80, 27 + 7 ≤ 34, 7.
TEST_F(Limited, ReachesATargetAndRestsThere) {
  EXPECT_EQ(follow(200, 8), (Offsets{20, 60, 120, 166, 193, 200, 200, 200}));
  EXPECT_EQ(status, 0U);
  EXPECT_EQ(limiter.largest(), 200);
  EXPECT_EQ(limiter.largest_lag(), 180);
}

TEST_F(Limited, StatesWhatKeepsItFromItsTarget) {
  follow(1'000, 4);
  EXPECT_EQ(status, kAccelerationLimited);
  EXPECT_EQ(limiter.step(), 80);
  follow(1'000, 1);
  EXPECT_EQ(status, kRateLimited);
  EXPECT_EQ(limiter.step(), 100);
}

// A held offset brakes by the acceleration instead of standing still at once.
TEST_F(Limited, HoldsByBraking) {
  follow(1'000, 3);
  ASSERT_EQ(limiter.offset(), 120);
  EXPECT_EQ(limiter.standstill(), 120 + 40 + 20);
  EXPECT_EQ(limiter.hold(), kAccelerationLimited);
  EXPECT_EQ(limiter.offset(), 160);
  limiter.hold();
  EXPECT_EQ(limiter.hold(), 0U);
  EXPECT_EQ(limiter.offset(), 180);
  EXPECT_EQ(limiter.standstill(), 180);
}

TEST_F(Limited, SoftTicksGoAtTheSoftRate) {
  for (int n = 1; n <= 5; ++n) {
    EXPECT_EQ(limiter.follow_softly(200), kRateLimited);
    EXPECT_EQ(limiter.offset(), 10 * n);
  }
}

// From 60 per tick to at most 10: braked by the old acceleration first, then limited by the new.
TEST_F(Limited, NewLimitsWaitUntilItIsSlowEnough) {
  follow(1'000, 3);
  limiter.change(OffsetBounds(OffsetLimits{1'000, 10, 10, 5}));
  follow(1'000, 1);
  EXPECT_TRUE(limiter.waiting());
  EXPECT_EQ(status, kSettling);
  EXPECT_EQ(limiter.step(), 40);
  follow(1'000, 2);
  EXPECT_EQ(limiter.step(), 0);
  follow(1'000, 1);
  EXPECT_FALSE(limiter.waiting());
  EXPECT_EQ(limiter.step(), 5);
}

TEST_F(Limited, ComesBackFromBeyondASmallerLimit) {
  follow(500, 30);
  limiter.change(OffsetBounds(OffsetLimits{450, 100, 10, 20}));
  EXPECT_EQ(follow(450, 4), (Offsets{480, 455, 450, 450}));
  begin(kLimits, 1'500);
  follow(1'000, 1);
  EXPECT_EQ(status, kAccelerationLimited | kSettling);
}

TEST_F(Limited, WaitingLimitsAreReplacedByLaterOnes) {
  follow(1'000, 3);
  limiter.change(OffsetBounds(OffsetLimits{1'000, 1, 1, 1}));
  limiter.change(OffsetBounds(kLimits));
  follow(1'000, 1);
  EXPECT_FALSE(limiter.waiting());
  EXPECT_EQ(limiter.step(), 80);
}

// Another one goes on from where this one was, without a bend.
TEST_F(Limited, ResumesAnother) {
  follow(1'000, 7);
  OffsetLimiter<true> other;
  other.change(OffsetBounds(kLimits));
  other.resume(limiter.offset(), limiter.step(), 1'000);
  for (int n = 0; n < 30; ++n) {
    const std::uint32_t wanted = limiter.follow(300);
    ASSERT_EQ(other.follow(300), wanted);
    ASSERT_EQ(other.offset(), limiter.offset());
  }
}

// One bit of what the fast path works with.
TEST_F(Limited, IntactShowsChangedBoundsInForce) {
  follow(1'000, 3);
  EXPECT_TRUE(limiter.intact());
  limiter.change(OffsetBounds(OffsetLimits{1'000, 1, 1, 1}));
  EXPECT_TRUE(limiter.intact()) << "waiting";
  follow(1'000, 20);
  EXPECT_TRUE(limiter.intact()) << "taken";
}

// --- the promises

TEST(OffsetPromises, HoldUnderHostileTargetsChangesHoldsAndStarts) {
  OffsetStorm<OffsetLimiter<true>> storm(seed());
  EXPECT_TRUE(storm.run(kManyPoints)) << storm.broken() << ", random seed " << seed();
  EXPECT_GT(storm.counts().limited, std::uint64_t{kManyPoints} / 5);
  EXPECT_GT(storm.counts().changes, std::uint64_t{kManyPoints} / 2'000);
  EXPECT_GT(storm.counts().waiting, 0U);
  EXPECT_GT(storm.counts().outside, std::uint64_t{kManyPoints} / 200);
  EXPECT_GT(storm.counts().compared, std::uint64_t{kManyPoints} / 25);
}

TEST(OffsetPromises, HoldWithoutAcceleration) {
  OffsetStorm<OffsetLimiter<false>> storm(seed());
  EXPECT_TRUE(storm.run(kManyPoints)) << storm.broken() << ", random seed " << seed();
}

}  // namespace
}  // namespace volcomp::test
