// What a user states about offsets, and what a tick makes of it.

#include <gtest/gtest.h>

#include "tests/oracle/limited_offset.hpp"

namespace volcomp::test {
namespace {

using Values = std::initializer_list<std::int32_t>;

TEST(OffsetBounds, WaysAndStepsAreThoseOfTheSums) {
  for (std::int32_t a = 1; a <= 50; ++a) {
    for (std::int32_t x = 0; x <= 300; ++x) {
      ASSERT_EQ(stopping_way(x, a), way_of(x, a)) << x << " by " << a;
      ASSERT_EQ(stopping_step(x, a), step_within(x, a)) << x << " by " << a;
      ASSERT_EQ(step_within_by_division(x, a), step_within(x, a)) << x << " by " << a;
    }
  }
}

// 10 + 7 + 4 + 1 = 22 by hand.
TEST(OffsetBounds, ByHand) {
  EXPECT_EQ(stopping_way(10, 3), 22);
  EXPECT_EQ(stopping_step(22, 3), 10);
  EXPECT_EQ(stopping_step(21, 3), 9);  // 9 + 6 + 3 = 18
  EXPECT_EQ(stopping_way(0, 3), 0);
  EXPECT_EQ(stopping_way(-5, 3), 0);
}

TEST(OffsetBounds, TheEndsOfTheirRangesDoNotOverflow) {
  constexpr std::int32_t kFurthest = 1 << 30;
  for (const std::int32_t a : Values{1, 2, 3, 1000, kMostOffsetAcceleration}) {
    const std::int32_t step = stopping_step(kFurthest, a);
    EXPECT_LE(way_of(step, a), kFurthest) << a;
    EXPECT_GT(way_of(step + 1, a), kFurthest) << a;
  }
}

TEST(OffsetBounds, AreUsedAsDefined) {
  for (const std::int32_t limit : Values{1, 2, 3, 50, 200'000, kMostOffsetLimit}) {
    for (const std::int32_t rate : Values{1, 2, 7, 1'250, 10'000, kMostOffsetRate}) {
      for (const std::int32_t acceleration : Values{0, 1, 2, 8, 500, kMostOffsetAcceleration}) {
        const OffsetLimits l{limit, rate, (rate + 1) / 2, acceleration};
        if (refused_field(l) != nullptr) continue;
        const OffsetBounds used(l);
        const UsedLimits defined(l);
        EXPECT_EQ(used.limit, defined.limit);
        EXPECT_EQ(used.rate, defined.rate) << limit << ' ' << rate << ' ' << acceleration;
        EXPECT_EQ(used.soft_rate, defined.soft_rate);
        EXPECT_EQ(used.acceleration, defined.acceleration);
        EXPECT_EQ(used.free, defined.followed);
        EXPECT_EQ(used.none(), defined.none);
        EXPECT_GE(2 * Int{used.free}, limit) << "at least half of it is followed";
      }
    }
  }
}

TEST(OffsetBounds, TheFirstFieldThatIsWrongIsNamed) {
  const OffsetLimits good{100, 10, 5, 3};
  EXPECT_EQ(refused_field(good), nullptr);
  const auto refused = [&](auto change) {
    OffsetLimits l = good;
    change(l);
    return refused_field(l);
  };
  for (const std::int32_t bad : Values{INT32_MIN, -1, 0, kMostOffsetLimit + 1})
    EXPECT_STREQ(refused([&](OffsetLimits& l) { l.limit = bad; }), "limit");
  for (const std::int32_t bad : Values{INT32_MIN, -1, 0, kMostOffsetRate + 1})
    EXPECT_STREQ(refused([&](OffsetLimits& l) { l.rate = bad; }), "rate");
  for (const std::int32_t bad : Values{INT32_MIN, -1, 0, 11, INT32_MAX})
    EXPECT_STREQ(refused([&](OffsetLimits& l) { l.soft_rate = bad; }), "soft_rate");
  for (const std::int32_t bad : Values{INT32_MIN, -1})
    EXPECT_STREQ(refused([&](OffsetLimits& l) { l.acceleration = bad; }), "acceleration");
  const auto faster = [&](OffsetLimits& l) { l = {100, kMostOffsetRate, 5, (1 << 24) + 1}; };
  EXPECT_STREQ(refused(faster), "acceleration");
  EXPECT_STREQ(refused([](OffsetLimits& l) { l = {0, 0, 0, -1}; }), "limit");
}

TEST(OffsetBounds, TwiceTheRateIsNone) {
  EXPECT_FALSE(OffsetBounds(OffsetLimits{100, 10, 5, 19}).none());
  for (const std::int32_t none : Values{0, 20, INT32_MAX}) {
    const OffsetLimits l{100, 10, 5, none};
    EXPECT_EQ(refused_field(l), nullptr);
    EXPECT_TRUE(OffsetBounds(l).none()) << none;
    EXPECT_EQ(OffsetBounds(l).acceleration, 20) << none;
  }
}

}  // namespace
}  // namespace volcomp::test
